#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "LightPropagation/Angular/AngularValues.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Sweep/Deposit.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "Medium/VoxelBox.h"

#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// Planes that a ray goes round a periodic axis at most, unless the sweep is told another number.
constexpr int MostPlanesAround = 8192;
/// Of what was on the way round a periodic axis after the first time: not worth going round again.
constexpr double NothingLeft = 1e-7;

/// The bundles of rays that march along one axis.
struct AxisBundles
{
  int axis;
  std::vector<Bundle> bundles;
};

/// What a sweep is made for.
struct SweepRequest
{
  Deposit deposit; ///< its buffers must stay
  std::vector<AxisBundles> rays;
  VoxelBox box = {};                 ///< the part of the grid that is swept; empty: all
  int mostPlanes = MostPlanesAround; ///< that rays go round a periodic axis before they wait for the next sweep
  bool sameBoundary = false;         ///< every sweep is given the same boundary: what it makes of it is kept
  /// Along the directions of the rays, must stay: sources and path integrals are angular moments, and net flux is among
  /// them. Null: they are those of fluence alone.
  const AngularValues* angular = nullptr;
  /// W / (length^2 sr) that comes in through each cell of the box's faces, the same from all directions,
  /// [channel][cell] (BoxFaces.h), beside what each sweep is given as boundary; not among the powers that came in. Must
  /// stay; null: nothing.
  const Buffer<float>* faceIn = nullptr;
  /// W / (length^3 sr), [channel][octant][stride]: by how much more than the source voxels shine out of themselves into
  /// the octant of directions that are positive along x where bit 0 is set, along y, z bits 1 and 2. What so gets out
  /// more, or less, is missing from their own path, or left in it: power is that of the source. Not with angular
  /// moments. Must stay; null: voxels shine alike into all octants.
  const Buffer<float>* octantSource = nullptr;
};

/// Carries light once through the medium: from what shines in its voxels and what comes in through the box's faces to
/// path integrals, net flux, partial currents and the power that left (numerics.md, section 4). Power is conserved,
/// Eq. (27). Independent of scattering orders and of acceleration. SweepInMemory.h does it in one device's memory;
/// other implementations may do it slice by slice, over several machines or in another order.
class SweepOperator
{
public:
  virtual ~SweepOperator() = default;

  /// Adds to the deposit that the operator was made with.
  /// @param source  W / (length^3 sr), [channel][stride], with angular moments [function, then beam][channel][stride];
  /// null: the medium is dark
  /// @param boundary  what comes in, three channels; empty: nothing
  /// @param monitor  given fractions of this sweep
  /// @return of all channels: what came in, what left, what still goes round a periodic axis, as it will in the next
  /// sweep
  virtual SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) = 0;

  /// Discards the rays that are under way round periodic axes; their power was told as SweepTally::onTheWay.
  virtual void Forget() = 0;
};

/// Makes sweeps of one medium: who sweeps asks for one here, and does not know how it is done.
using SweepMaker = std::function<std::unique_ptr<SweepOperator>(const SweepRequest&)>;
}
