#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Sweep/Deposit.h"
#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

namespace tyndall
{
/// Results of lanes that run concurrently or wrap around an axis, each in its own arrays: [lane], then as in the
/// deposit. AddUp() adds them to the deposit in the order of the lanes, so that results are identical, bit for bit, to
/// those of lanes that add to the deposit directly.
class LaneArrays
{
public:
  /// @param lanes  must outlive this object
  /// @param to  the deposit; without flux if the flux is among the angular moments
  LaneArrays(Device& device, const GpuLanes& lanes, const VolumeLayout& layout, const Deposit& to);

  void Clear(const LaneBatch& batch);
  /// @param launch  a launch of the batch
  void AddUp(const LaneBatch& batch, const PlaneLaunch& launch, const SweepVolume& volume);

  Buffer<float> path, flux, currents;
  Buffer<float> lost; ///< rounding errors of `path` (compensated summation), for lanes that wrap around

private:
  void AddUpMoments(const LaneBatch& batch, const PlaneLaunch& launch, const SweepVolume& volume);

  Device& TheDevice;
  const GpuLanes& Lanes;
  VolumeLayout Layout;
  Deposit To;
};
}
