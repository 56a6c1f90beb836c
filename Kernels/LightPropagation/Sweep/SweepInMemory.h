#pragma once

#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Sweep/AxisSweep.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// Sweep of a volume in the memory of one device.
class SweepInMemory : public SweepOperator
{
public:
  /// @param sigma_t  must outlive the sweep
  /// @param workspace  must outlive the sweep; may be shared by sweeps that never run concurrently
  SweepInMemory(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
    const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace);

  SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) override;
  void Forget() override;

private:
  SweepVolume VolumeOf(const ChannelGroup& group, const Buffer<float>* source) const;

  VolumeLayout Layout;
  const Buffer<float>& SigmaT;
  Deposit To;
  VoxelBox Box;
  int MostPlanes;
  const AngularValues* Angular;
  const Buffer<float>* FaceIn;
  const Buffer<float>* OctantSource;
  /// Sweeps along one axis. An open axis has one AxisSweep, used for all groups of channels in turn; a periodic axis
  /// has one per group, because it keeps the rays under way from one sweep to the next.
  struct Axis
  {
    std::vector<std::unique_ptr<AxisSweep>> ofGroups;
    AxisSweep& Of(std::size_t group) const { return *this->ofGroups[this->ofGroups.size() == 1 ? 0 : group]; }
  };
  std::vector<Axis> Axes;
};
}
