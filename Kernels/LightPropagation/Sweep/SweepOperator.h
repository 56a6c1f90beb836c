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
/// Output arrays of a sweep, in the layout of VolumeLayout. The sweep adds to their values.
struct Deposit
{
  /// Path integral of power per voxel, W length, [channel][voxel]; with angular moments [angular
  /// function][channel][voxel], where the moment of the first function is the path integral
  const Buffer<float>* path = nullptr;
  const Buffer<float>* flux = nullptr; ///< net flux, W length, [channel][x, y, z][voxel]; null: not computed
  /// Power that enters each voxel through each of its faces (numerics.md, Eq. (29)), W, [channel][-x, +x, -y, +y, -z,
  /// +z][voxel]; null: not computed
  const Buffer<float>* partialCurrents = nullptr;
  /// First moments of the deposit of lamps, W length, [channel][-x, +x, -y, +y, -z, +z][voxel]: for each face, the path
  /// integral times the displacement, in voxels (0 to 1/2), of the mean position of collisions from the voxel's centre
  /// towards the face (numerics.md, Eq. (37)). 0 in voxels thinner than ThinForFirstMoments. Null: not computed.
  const Buffer<float>* firstMoments = nullptr;
  /// Escaped power per cell of the box's faces, W, [channel][cell] (BoxFaces.h); null: not computed. Requires a sweep
  /// of the whole domain.
  const Buffer<float>* faceOut = nullptr;
  /// Whether escaped power is spread along a face. A ray nearly parallel to a face meets it only every few cells. Its
  /// power is then spread over as many cells as lie between two of these crossings. False: all of its power leaves
  /// through the cell that it meets, as for incident light.
  bool spreadsAside = false;
};

/// In voxels of smaller optical thickness, collisions of lamps' light are taken as uniformly distributed.
constexpr float ThinForFirstMoments = 0.02f;

/// Rule that assigns the power of a ray to cells of a face, one cell per plane of voxels. The ray leaves through this
/// face, which is parallel to the marching axis. A ray nearly parallel to the face meets only few of the cells; it may
/// represent the power that leaves through several of them (Deposit::spreadsAside).
struct AsidePlanes
{
  int size;
  bool periodic;
  /// Whether the power is divided among several planes; false: all of it leaves in the plane in which the ray meets the
  /// face
  bool spreads;
};

/// Calls act(plane, part) for each plane through whose cells a ray leaves, with the fraction of the ray's power that
/// leaves there. SweepSides.cl has the same function in OpenCL.
/// @param tangent  sideways moves of the ray, voxels per plane
/// @param plane    index of the plane in which the ray moves sideways
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
  Rgb onTheWay = {}; ///< power of the rays still in transit along periodic axes at the end of the sweep
};

/// Adds `power` to `sum`, both by face and channel, W.
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

/// Incident radiance, W / (length^2 sr), along `direction` (index in the quadrature) at `face` (0 to 5: -x to +z). For
/// parallel beams, the value is the irradiance on a plane normal to the beam, W / length^2, and `direction` is 0.
using SweepBoundary = std::function<Rgb(int direction, int face)>;

/// Returns the values of `rgb` for the group of channels (VolumeLayout.h) whose first channel is `first`: all three if
/// `first` is 0, else that of channel `first`, as channel 0.
inline Rgb OfGroup(const Rgb& rgb, int first)
{
  return first == 0 ? rgb : Rgb{ rgb[first], 0.0, 0.0 };
}
/// Returns the incident radiance of the group of channels that begins at `first`.
/// @param boundary  must outlive the result; may be empty
inline SweepBoundary OfGroup(const SweepBoundary& boundary, int first)
{
  return boundary && first > 0
    ? [&boundary, first](int direction, int face) { return OfGroup(boundary(direction, face), first); }
    : boundary;
}

/// Default of the maximum number of planes that a ray crosses along a periodic axis in one sweep.
constexpr int MostPlanesAround = 8192;
/// Rays stop wrapping around a periodic axis once their total power has fallen to this fraction of their power after
/// the first lap.
constexpr double NothingLeft = 1e-7;

/// Bundles of rays that march along one axis (0, 1, 2: x, y, z).
struct AxisBundles
{
  int axis;
  std::vector<Bundle> bundles;
};

/// Properties of a sweep that are fixed when it is constructed.
struct SweepRequest
{
  Deposit deposit; ///< output arrays; its buffers must outlive the sweep
  std::vector<AxisBundles> rays;
  VoxelBox box = {}; ///< region of the grid that is swept, voxels; empty: the whole grid
  /// Maximum number of planes that rays cross along a periodic axis in one sweep; the next sweep carries them on
  int mostPlanes = MostPlanesAround;
  /// Whether the boundary source is the same in every sweep, so that the incident power of the rays is cached
  bool sameBoundary = false;
  /// Values, in the rays' directions, of the angular functions (spherical harmonics) in which light is expanded; must
  /// outlive the sweep. Sources and path integrals are then angular moments, which include the net flux. Null: no
  /// angular moments, fluence only.
  const AngularValues* angular = nullptr;
  /// Isotropic incident radiance per cell of the box's faces, W / (length^2 sr), [channel][cell] (BoxFaces.h), in
  /// addition to the boundary source of each sweep; not counted as incident power in the tally. Must outlive the sweep;
  /// null: none.
  const Buffer<float>* faceIn = nullptr;
  /// Additional source per octant of directions, W / (length^3 sr), [channel][octant][voxel], added to the source for
  /// light that leaves the voxel. Bits 0, 1, 2 of an octant's index are set if its directions are positive along x, y,
  /// z. The power that this source adds to rays is taken from the power that the voxel removes from rays, so it adds no
  /// power in total. Not with angular moments. Must outlive the sweep; null: the source is the same in all octants.
  const Buffer<float>* octantSource = nullptr;
  /// Whether the sweep may omit, in voxels without medium, all angular moments of the path integrals except the first;
  /// the omitted moments include the net flux
  bool skipsEmpty = false;
};

/// One sweep: carries light of sources in the voxels, and light incident on the box's faces, once through the medium.
/// Computes path integrals, net flux, partial currents and escaped power (numerics.md, section 4). Power is conserved,
/// Eq. (27). The interface does not depend on source iteration or its acceleration. SweepInMemory.h sweeps in the
/// memory of one device; other implementations may sweep slice by slice or over several ranks.
class SweepOperator
{
public:
  virtual ~SweepOperator() = default;

  /// Sweeps once and adds to the request's deposit.
  /// @param source  W / (length^3 sr), [channel][voxel], with angular moments [angular function, then
  ///   beam][channel][voxel]; null: no source
  /// @param boundary  incident light, three channels; empty: none
  /// @param monitor  receives the completed fraction of this sweep, 0 to 1
  /// @return incident power, escaped power, and power in transit along periodic axes, which continues in the next
  /// sweep; W, all channels
  virtual SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) = 0;

  /// Discards the rays in transit along periodic axes; SweepTally::onTheWay has reported their power.
  virtual void Forget() = 0;
};

/// Factory of sweeps of one medium; solvers use it without knowledge of the implementation.
using SweepMaker = std::function<std::unique_ptr<SweepOperator>(const SweepRequest&)>;
}
