#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "Lights/Lights.h"
#include "Medium/VoxelBox.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// Output arrays of a sweep. All of them are added to.
struct Deposit
{
  /// Path integral, W length, [channel][stride]; with angular moments [function][channel][stride], where the first
  /// function is the path integral
  const Buffer<float>* path = nullptr;
  const Buffer<float>* flux = nullptr; ///< net flux, W length, [channel][x, y, z][stride]; null: not computed
  /// Power that enters each voxel through each of its faces (numerics.md, Eq. (29)), W, [channel][-x, +x, -y, +y, -z,
  /// +z][stride]; null: not computed
  const Buffer<float>* partialCurrents = nullptr;
  /// First moments of the deposit, W length, [channel][-x, +x, -y, +y, -z, +z][stride], added to by lamps: path
  /// integral times the distance from the voxel's centre towards each face, in voxels (0 to 1/2), of the mean position
  /// at which its light is lost (numerics.md, Eq. (37)). 0 in voxels thinner than ThinForFirstMoments. Null: not
  /// computed.
  const Buffer<float>* firstMoments = nullptr;
  /// Escaped power, W, by cell of the box's faces, [channel][cell] (BoxFaces.h); null: not computed. Requires that the
  /// whole grid is swept.
  const Buffer<float>* faceOut = nullptr;
  /// True: a ray nearly parallel to a face, which meets it only every few cells, spreads its power over the cells it
  /// represents. False: all its power leaves through the cell that it meets, as for incident light.
  bool spreadsAside = false;
};

/// Optical thickness of a voxel below which the light of lamps is taken as lost uniformly in it.
constexpr float ThinForFirstMoments = 0.02f;

/// Planes of voxels along the marching axis, for rays that leave sideways through a face of the box. A ray nearly
/// parallel to the face represents the power that leaves through cells of several planes (Deposit::spreadsAside).
struct AsidePlanes
{
  int size;
  bool periodic;
  bool spreads; ///< false: a ray leaves through the cell of its own plane only
};

/// Calls act(plane, part) for each plane through whose cells a ray leaves, with the part of its power that leaves
/// there; same as in SweepSides.cl.
/// @param tangent  sideways moves of the ray, voxels per plane
/// @param plane    plane in which the ray moves sideways
template <class Act>
void ForPlanesPassed(const AsidePlanes& aside, double tangent, int plane, const Act& act)
{
  if (!aside.spreads)
  {
    act(plane, 1.0);
    return;
  }
  const double planes = tangent * aside.size > 1.0 ? 1.0 / tangent : aside.size, middle = plane + 0.5;
  const double begin = aside.periodic ? middle - 0.5 * planes : std::max(middle - 0.5 * planes, 0.0);
  const double end = aside.periodic ? middle + 0.5 * planes : std::min(middle + 0.5 * planes, 1.0 * aside.size);
  for (int p = static_cast<int>(std::floor(begin)); p < end; ++p)
  {
    act((p + aside.size) % aside.size, (std::min(end, p + 1.0) - std::max(begin, 1.0 * p)) / (end - begin));
  }
}

/// Incident and escaped power of a sweep, W, by face (-x, +x, -y, +y, -z, +z) and channel.
struct SweepTally
{
  std::array<Rgb, 6> in = {};
  std::array<Rgb, 6> out = {};
  Rgb onTheWay = {}; ///< power of rays still under way round a periodic axis, in its maps
};

/// Adds powers by face.
/// @param first  channel of `sum` that corresponds to channel 0 of `power`
inline void AddTo(std::array<Rgb, 6>& sum, const std::array<Rgb, 6>& power, int first = 0)
{
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; first + c < 3; ++c)
    {
      sum[face][first + c] += power[face][c];
    }
  }
}

inline void Add(SweepTally& sum, const SweepTally& tally, int first = 0)
{
  AddTo(sum.in, tally.in, first);
  AddTo(sum.out, tally.out, first);
  for (int c = 0; first + c < 3; ++c)
  {
    sum.onTheWay[first + c] += tally.onTheWay[c];
  }
}

/// Incident radiance, W / (length^2 sr), in `direction` (an index into the direction set) at `face`. For parallel
/// beams: their irradiance, W / length^2, and `direction` is 0.
using SweepBoundary = std::function<Rgb(int direction, int face)>;

/// Channels of the group (VolumeLayout.h) that begins at `first`: all three if `first` is 0, else channel `first` moved
/// to 0.
inline Rgb OfGroup(const Rgb& rgb, int first)
{
  return first == 0 ? rgb : Rgb{ rgb[first], 0.0, 0.0 };
}
/// @param boundary  must outlive the result; may be empty
inline SweepBoundary OfGroup(const SweepBoundary& boundary, int first)
{
  return boundary && first > 0
    ? [&boundary, first](int direction, int face) { return OfGroup(boundary(direction, face), first); }
    : boundary;
}

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
