#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Sweep/Deposit.h"
#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

namespace tyndall
{
/// What lanes find that go side by side or round an axis, each in arrays of its own, [lane], else as the deposit's; and
/// its adding up, in the order of the lanes, as those do that add to the deposit themselves: the same bits.
class LaneArrays
{
public:
  /// @param lanes  must stay
  /// @param to  the deposit, without a flux that is among angular moments
  LaneArrays(Device& device, const GpuLanes& lanes, const VolumeLayout& layout, const Deposit& to);

  void Clear(const LaneBatch& batch);
  /// @param launch  of the batch
  void AddUp(const LaneBatch& batch, const PlaneLaunch& launch, const SweepVolume& volume);

  Buffer<float> path, flux, currents;
  Buffer<float> lost; ///< by rounding from path, of lanes that go round

private:
  void AddUpMoments(const LaneBatch& batch, const PlaneLaunch& launch, const SweepVolume& volume);

  Device& TheDevice;
  const GpuLanes& Lanes;
  VolumeLayout Layout;
  Deposit To;
};
}
