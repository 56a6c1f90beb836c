#pragma once

#include "LightPropagation/Sweep/AxisSweep.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// Creates the sweep of a volume in the memory of one device: a SweepOnGpu on a GPU, a SweepInMemory on a CPU.
/// @param sigma_t, workspace  must outlive the sweep; the workspace may be shared by sweeps that never run concurrently
std::unique_ptr<SweepOperator> SweepOfDevice(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
  const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace);

/// Sweep of a volume in the memory of one device, organised for CPUs. The parameters are those of SweepOfDevice.
class SweepInMemory : public SweepByGroups
{
public:
  SweepInMemory(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
    const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace);

  void Forget() override;

private:
  SweepTally ApplyGroup(
    std::size_t group, const SweepVolume& volume, const SweepBoundary& boundary, const Monitor& monitor) override;

  /// Sweeps along one axis. An open axis has one AxisSweep for all groups of channels; a periodic axis has one per
  /// group, because it keeps the rays in transit from one sweep to the next.
  struct Axis
  {
    std::vector<std::unique_ptr<AxisSweep>> ofGroups;
    AxisSweep& Of(std::size_t group) const { return *this->ofGroups[this->ofGroups.size() == 1 ? 0 : group]; }
  };
  std::vector<Axis> Axes;
};
}
