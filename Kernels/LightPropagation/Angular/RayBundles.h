#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "Medium/Grid.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// How the rays of light propagation maps run through a grid, worked out once on the host, in double (numerics.md,
/// section 4.2).
///
/// Rays march along an axis of the grid, plane by plane. All rays of one direction start on the lattice of the voxels,
/// so they cross every plane in the same pattern: at most three voxels, one shift of the whole map. Directions that are
/// mirror images of each other (and, where voxels are square across the axis, those with both tangents swapped) share
/// the lengths of all segments: they make a Bundle, and transmittance is computed once for it.
///
/// Promises: every voxel is crossed by every segment, so that a source enters with all of its power (Eq. (20)); one
/// move aside of the pattern is made by a part of each ray's power, so that exactly the power of a direction enters
/// through the box's sides (Eqs. (21), (28)).

/// The part of a plane that a ray crosses in one voxel.
struct Segment
{
  int moveU = 0; ///< voxels moved since the segment before, in the bundle's own frame (both tangents positive): 0 or 1
  int moveV = 0;
  double part = 1.0;   ///< of each ray's power that moves; the rest stays
  double length = 0.0; ///< along the ray, in the dataset's unit
};

/// What a bundle does in one plane: one to three segments.
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

/// A move aside by one voxel within a plane.
struct Move
{
  double depth = 2.0; ///< where, 0 the plane's entry, 1 its exit; above 1: there is none
  double part = 1.0;  ///< of each ray's power
};

struct Bundle
{
  double tangentU = 0.0; ///< voxels moved per plane, 0 <= tangent <= 1
  double tangentV = 0.0;
  double startU = 0.5; ///< where rays start within a voxel of the first plane, in (0, 1)
  double startV = 0.5;
  double length = 1.0; ///< of a ray within one plane
  double power = 1.0;  ///< that a ray carries at radiance 1: weight |cos| area, length^2 sr; numerics.md, Eq. (19)
  /// By plane of the pattern, from where rays start; empty where both axes are periodic, so that nothing enters on the
  /// way: whole moves.
  std::vector<Move> movesU, movesV;
  std::vector<Member> members;

  /// Planes are counted from where the rays start; behind the last one the pattern begins anew, but for whole moves,
  /// which go on.
  PlaneCrossing Crossing(int plane) const;
  /// All moves are along both axes at once: tangents and starts are equal.
  bool MovesBothWaysAtOnce() const;
};

/// Planes after which a pattern along an axis of `size` voxels begins anew: as many as there are, or several times
/// those of a short periodic axis, where rays go round.
int PlanesOfPattern(int size, bool periodic);

/// The axis that a direction marches along: the one of whose voxel planes it crosses most per unit length, so that it
/// never moves more than one voxel aside. Where it crosses the planes of several alike, all of these, in equal parts.
std::vector<int> MarchingAxes(const Grid& grid, const std::array<double, 3>& omega);

/// Of a direction's power, the part that marches along `axis`: 0, 1, or where several axes share it 1/2 or 1/3.
double PartMarching(const Grid& grid, const std::array<double, 3>& omega, int axis);

/// Where the rays of a bundle start within a voxel of the first plane, or within its part on a finer lattice.
enum class RayStarts
{
  Middle,   ///< all alike
  Staggered ///< each bundle's in a place of its own: patterns at the box's sides even out the more bundles there are
};

/// The bundles that march along `axis`, both ways, with mapResolution x mapResolution rays a voxel and direction.
std::vector<Bundle> BundlesAlong(int axis, const Grid& grid, const std::array<bool, 3>& periodic,
  const DirectionSet& set, int mapResolution, RayStarts starts = RayStarts::Middle);

/// Rays of one collimated beam: a bundle with one member for each of the mapResolution^2 lattices. Its `direction` is 0
/// where the beam runs forward along the axis, else `opposite` is 0; the other is -1. Power is that of irradiance 1.
std::vector<Bundle> BeamAlong(int axis, const Grid& grid, const std::array<bool, 3>& periodic,
  const std::array<double, 3>& omega, int mapResolution);

/// The rays of bundles that march one way along the axis (0 forward, 1 backward), of directions that are lit.
std::vector<Bundle> LitRays(const std::vector<Bundle>& bundles, int way, const std::function<bool(int)>& isLit);

/// Rays of the bundles a voxel, both ways.
int CountRays(const std::vector<Bundle>& bundles);
}
