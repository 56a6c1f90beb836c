#pragma once

#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Sweep/SweepWorkspace.h"

#include "Device/Monitor.h"

#include <memory>

namespace tyndall
{
/// Carries all rays of a set of bundles through a volume along one axis, and deposits what they lose: propagation and
/// collection in one, without a buffer a direction (Gruson et al. need one, their section 4.1; numerics.md, section 4).
///
/// Memory: the maps, (plane's voxels) floats a direction and channel and way, and a few planes of scratch a unit; both
/// in a workspace, except for a periodic axis, whose rays stay on the way from one sweep to the next.
class AxisSweep
{
public:
  /// @param volume  its grid, its channels and whether it has a flux count
  /// @param workspace  must stay; made as large as is needed
  /// @param sameBoundary  every sweep of a volume is given the same boundary
  AxisSweep(Device& device, const SweepVolume& volume, int axis, const std::vector<Bundle>& bundles,
    const std::array<bool, 3>& periodic, SweepWorkspace& workspace, bool sameBoundary = false);
  ~AxisSweep();

  /// Once through the volume, both ways. Queues the work and, on an open axis, does not wait for it.
  /// @param boundary  what comes in; empty: nothing
  /// @param mostPlanes  that rays go on a periodic axis before they wait for the next sweep
  /// @param monitor  given fractions of this sweep
  void Start(const SweepVolume& volume, const SweepBoundary& boundary, int mostPlanes, const Monitor& monitor);

  /// Discards the rays that are still on the way round a periodic axis.
  void Forget();

  /// Wait for the sweep that was started.
  SweepTally Finish();

private:
  struct Implementation;
  std::unique_ptr<Implementation> Inner;
};
}
