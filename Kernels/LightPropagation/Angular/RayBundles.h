#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "Medium/Grid.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Geometry of the rays of light propagation maps in a grid, computed once, on the host, in double precision
/// (numerics.md, section 4.2).
///
/// Rays march along an axis of the grid, plane by plane. All rays of one direction start on the lattice of the voxels,
/// so they cross a plane in the same pattern: at most three voxels per ray, and the whole map shifts at once.
/// Directions that are mirror images of each other (and, if voxels are square across the axis, those with both tangents
/// swapped) have segments of the same lengths. They form a Bundle, for which transmittance is computed once.
///
/// Guarantees: every voxel is crossed by every segment, so that a source emits all of its power (Eq. (20)); one
/// sideways move of the pattern is made by only a part of each ray's power, so that exactly the power of a direction
/// enters through the box's sides (Eqs. (21), (28)).

/// The part of a plane that a ray crosses in one voxel.
struct Segment
{
  int moveU = 0; ///< voxels moved since the segment before, in the bundle's own frame (both tangents positive): 0 or 1
  int moveV = 0;
  double part = 1.0;   ///< part of each ray's power that moves; the rest stays
  double length = 0.0; ///< along the ray, in the dataset's unit
};

/// How a bundle crosses one plane: one to three segments.
struct PlaneCrossing
{
  int count = 1;
  std::array<Segment, 3> segments;
};

/// One ray family of a bundle: a direction, and how the bundle's frame maps to the plane's axes.
struct Member
{
  int direction = 0; ///< index into the direction set (the one that marches forward along the axis)
  int opposite = 0;  ///< its mirror image that marches backward
  int uFromU = 1, uFromV = 0, vFromU = 0, vFromV = 1; ///< a signed permutation
};

/// A sideways move by one voxel within a plane.
struct Move
{
  double depth = 2.0; ///< position of the move: 0 at the plane's entry, 1 at its exit; above 1: no move
  double part = 1.0;  ///< part of each ray's power that moves
};

struct Bundle
{
  double tangentU = 0.0; ///< voxels moved per plane, 0 <= tangent <= 1
  double tangentV = 0.0;
  double startU = 0.5; ///< where rays start within a voxel of the first plane, in (0, 1)
  double startV = 0.5;
  double length = 1.0; ///< length of a ray within one plane
  double power = 1.0;  ///< power of a ray at radiance 1: weight |cos| area, length^2 sr; numerics.md, Eq. (19)
  /// Moves by plane of the pattern, counted from where rays start. Empty if both axes across are periodic: no light
  /// enters sideways, and all moves are whole.
  std::vector<Move> movesU, movesV;
  std::vector<Member> members;

  /// Crossing of a plane, counted from where the rays start. After the last plane the pattern repeats, except whole
  /// moves, which continue.
  PlaneCrossing Crossing(int plane) const;
  /// Whether all moves are along both axes at once, i.e. tangents and starts are equal.
  bool MovesBothWaysAtOnce() const;
};

/// Planes after which the ray pattern along an axis of `size` voxels repeats: `size`, or a multiple of it for a short
/// periodic axis, whose rays wrap around.
int PlanesOfPattern(int size, bool periodic);

/// Marching axis of a direction: the one whose voxel planes it crosses most often per unit length, so that it never
/// moves sideways by more than one voxel per plane. If several axes are equal in this, all of them, in equal parts.
std::vector<int> MarchingAxes(const Grid& grid, const std::array<double, 3>& omega);

/// Part of a direction's power that marches along `axis`: 0 or 1; 1/2 or 1/3 if several axes share it.
double PartMarching(const Grid& grid, const std::array<double, 3>& omega, int axis);

/// Where the rays of a bundle start within a voxel of the first plane, or within its part on a finer lattice.
enum class RayStarts
{
  Middle, ///< in the middle, for all bundles
  /// At a different position for each bundle, so that patterns at the box's sides average out over the bundles
  Staggered
};

/// Bundles that march along `axis`, both ways, with mapResolution x mapResolution rays per voxel and direction.
std::vector<Bundle> BundlesAlong(int axis, const Grid& grid, const std::array<bool, 3>& periodic,
  const DirectionSet& set, int mapResolution, RayStarts starts = RayStarts::Middle);

/// Rays of one collimated beam: one bundle, with one member, for each of the mapResolution^2 lattices. `direction` is 0
/// if the beam runs forward along the axis, otherwise `opposite` is 0; the other one is -1. Power is that of irradiance
/// 1.
std::vector<Bundle> BeamAlong(int axis, const Grid& grid, const std::array<bool, 3>& periodic,
  const std::array<double, 3>& omega, int mapResolution);

/// The members of `bundles` that march one way along the axis (0 forward, 1 backward) and whose direction is lit.
std::vector<Bundle> LitRays(const std::vector<Bundle>& bundles, int way, const std::function<bool(int)>& isLit);

/// Number of rays per voxel, both ways.
int CountRays(const std::vector<Bundle>& bundles);
}
