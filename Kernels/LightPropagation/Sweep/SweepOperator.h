#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Sweep/Deposit.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "Medium/VoxelBox.h"

#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// Most planes that a ray crosses round a periodic axis in one sweep, by default.
constexpr int MostPlanesAround = 8192;
/// Rays stop wrapping around a periodic axis when their power has fallen to this fraction of that after the first lap.
constexpr double NothingLeft = 1e-7;

/// The bundles of rays that march along one axis.
struct AxisBundles
{
  int axis;
  std::vector<Bundle> bundles;
};

/// Everything that a sweep is constructed for.
struct SweepRequest
{
  Deposit deposit; ///< its buffers must outlive the sweep
  std::vector<AxisBundles> rays;
  VoxelBox box = {}; ///< the part of the grid that is swept; empty: the whole grid
  /// Most planes that rays cross round a periodic axis before they wait for the next sweep
  int mostPlanes = MostPlanesAround;
  bool sameBoundary = false; ///< the boundary is the same in every sweep, so its processed form is cached
  /// Angular functions in the rays' directions; must outlive the sweep. Sources and path integrals are then angular
  /// moments, which include the net flux. Null: no angular moments, fluence only.
  const AngularValues* angular = nullptr;
  /// Isotropic incident radiance by cell of the box's faces, W / (length^2 sr), [channel][cell] (BoxFaces.h), in
  /// addition to the boundary that each sweep is given; not counted as incident power in the tally. Must outlive the
  /// sweep; null: none.
  const Buffer<float>* faceIn = nullptr;
  /// Additional source by octant of directions, W / (length^3 sr), [channel][octant][stride], relative to the source;
  /// it applies to light that leaves the voxel. An octant's bits 0, 1, 2 are set if its directions are positive along
  /// x, y, z. The extra power that leaves (or stays) is subtracted from (or added to) the voxel's own path, so the
  /// total power is that of the source. Not with angular moments. Must outlive the sweep; null: the source is the same
  /// in all octants.
  const Buffer<float>* octantSource = nullptr;
};

/// One sweep: carries light once through the medium, from the sources in its voxels and the light incident on the box's
/// faces to path integrals, net flux, partial currents and escaped power (numerics.md, section 4). Power is conserved,
/// Eq. (27). Independent of source iteration and its acceleration. SweepInMemory.h sweeps in the memory of one device;
/// other implementations may sweep slice by slice, over several machines or in another order.
class SweepOperator
{
public:
  virtual ~SweepOperator() = default;

  /// Sweeps once and adds to the request's deposit.
  /// @param source  W / (length^3 sr), [channel][stride], with angular moments [function, then beam][channel][stride];
  /// null: no source
  /// @param boundary  incident light, three channels; empty: none
  /// @param monitor  receives the fraction of this sweep that is done
  /// @return for all channels: incident power, escaped power, and the power still under way round periodic axes, which
  /// continues in the next sweep
  virtual SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) = 0;

  /// Discards the rays under way round periodic axes; their power was reported as SweepTally::onTheWay.
  virtual void Forget() = 0;
};

/// Factory of sweeps of one medium; hides the implementation from solvers.
using SweepMaker = std::function<std::unique_ptr<SweepOperator>(const SweepRequest&)>;
}
