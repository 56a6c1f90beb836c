#pragma once

#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Sweep/SweepWorkspace.h"

#include "Device/Monitor.h"

#include <memory>

namespace tyndall
{
/// Sweep along one axis: carries all rays of a set of bundles through a volume and deposits the power they lose.
/// Propagation and collection are done in one pass, without a buffer per direction (Gruson et al. need one, their
/// section 4.1; numerics.md, section 4).
///
/// Memory: one float per voxel of a plane, direction, channel and way for the maps, and a few planes of scratch per
/// unit. Both are in the workspace, except the maps of a periodic axis, whose rays are kept from one sweep to the next.
class AxisSweep
{
public:
  /// @param volume  its grid, its channels and the presence of a flux are used
  /// @param workspace  must outlive this object; enlarged as needed
  /// @param sameBoundary  the boundary is the same in every sweep of a volume
  AxisSweep(Device& device, const SweepVolume& volume, int axis, const std::vector<Bundle>& bundles,
    const std::array<bool, 3>& periodic, SweepWorkspace& workspace, bool sameBoundary = false);
  ~AxisSweep();

  /// Starts one sweep through the volume, both ways. Queues the work; on an open axis it returns without waiting.
  /// @param boundary  incident light; empty: none
  /// @param mostPlanes  most planes that rays cross on a periodic axis before they wait for the next sweep
  /// @param monitor  receives the fraction of this sweep that is done
  void Start(const SweepVolume& volume, const SweepBoundary& boundary, int mostPlanes, const Monitor& monitor);

  /// Discards the rays that are still under way round a periodic axis.
  void Forget();

  /// Waits for the sweep that was started.
  SweepTally Finish();

private:
  struct Implementation;
  std::unique_ptr<Implementation> Inner;
};
}
