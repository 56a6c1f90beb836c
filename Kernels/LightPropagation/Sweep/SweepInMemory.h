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
/// The sweep of a volume that lies in one device's memory.
class SweepInMemory : public SweepOperator
{
public:
  /// What is swept, and how.
  struct Description
  {
    const Buffer<float>* sigma_t = nullptr; ///< must stay, as the deposit must
    Deposit deposit;
    VoxelBox box; ///< the part that is swept; empty: all
    std::array<bool, 3> periodic = {};
    int mostPlanes = MostPlanesAround; ///< that rays go round a periodic axis before they wait for the next sweep
  };
  /// The bundles of rays that march along one axis.
  struct AxisBundles
  {
    int axis;
    std::vector<Bundle> bundles;
  };

  /// @param workspace  must stay; shared by sweeps that take turns
  SweepInMemory(Device& device, const VolumeLayout& layout, const Description& description,
    const std::vector<AxisBundles>& axes, SweepWorkspace& workspace);

  SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) override;
  void Forget() override;

private:
  SweepVolume VolumeOf(const ChannelGroup& group, const Buffer<float>* source) const;

  VolumeLayout Layout;
  Description The;
  /// Along one axis: one sweep for all groups of channels in turn; where the axis is periodic one a group, for it keeps
  /// rays that are on their way from one sweep to the next.
  struct Axis
  {
    std::vector<std::unique_ptr<AxisSweep>> ofGroups;
    AxisSweep& Of(std::size_t group) const { return *this->ofGroups[this->ofGroups.size() == 1 ? 0 : group]; }
  };
  std::vector<Axis> Axes;
};
}
