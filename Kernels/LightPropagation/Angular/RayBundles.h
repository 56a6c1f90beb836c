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
/// Rays march along an axis of the grid, plane by plane of voxels. All rays of one direction start at the same position
/// in their voxels. They therefore cross each plane in the same pattern of at most three voxels per ray. The light
/// propagation map, i.e. the radiance of these rays in a plane, moves sideways as a whole. Directions that are mirror
/// images of each other (and, if voxels are square across the axis, directions with exchanged tangents) have segments
/// of the same lengths. They form a Bundle, for which transmittance is computed once.
///
/// Power is exact in two respects. Every segment of the pattern crosses every voxel, so that a source emits all of its
/// power (Eq. (20)). One sideways move of the pattern is made by only a fraction of each ray's power, so that exactly
/// the incident power of each direction enters through the box's sides (Eqs. (21), (28)).

/// Segment of a ray: its path through one voxel of a plane.
struct Segment
{
  /// Voxels moved along u since the previous segment, in the bundle's frame (both tangents positive): 0 or 1.
  int moveU = 0;
  int moveV = 0;
  double part = 1.0;   ///< fraction of each ray's power that moves; the remainder stays in its voxel
  double length = 0.0; ///< length along the ray, in the dataset's unit
};

/// Path of a bundle's rays through one plane of voxels: one to three segments.
struct PlaneCrossing
{
  int count = 1;
  std::array<Segment, 3> segments;
};

/// One direction of a bundle (directions whose segments have the same lengths), its mirror image, and the signed
/// permutation that maps the bundle's axes to the plane's axes u and v.
struct Member
{
  int direction = 0; ///< index in the direction set of the direction that marches forward along the axis; -1: none
  int opposite = 0;  ///< index of the mirror image that marches backward; -1: none
  int uFromU = 1, uFromV = 0, vFromU = 0, vFromV = 1; ///< signed permutation from the bundle's axes to the plane's
};

/// Sideways move of all rays of a bundle by one voxel along u or v, the axes across the marching axis, at some depth of
/// a plane of voxels.
struct Move
{
  double depth = 2.0; ///< position of the move: 0 at the plane's entry, 1 at its exit; above 1: no move
  double part = 1.0;  ///< fraction of each ray's power that moves
};

struct Bundle
{
  double tangentU = 0.0; ///< voxels moved along u per plane, 0 to 1
  double tangentV = 0.0;
  double startU = 0.5; ///< position within a voxel of the first plane where rays start, in (0, 1)
  double startV = 0.5;
  double length = 1.0; ///< path length of a ray within one plane of voxels
  double power = 1.0;  ///< power of a ray at radiance 1: weight |cos| area, length^2 sr (numerics.md, Eq. (19))
  /// Moves along u and v in each plane of the pattern, counted from the plane where rays start. Empty if both axes
  /// normal to the marching axis are periodic: no light then enters sideways, and all of a ray's power makes each move.
  std::vector<Move> movesU, movesV;
  std::vector<Member> members;

  /// Segments in plane `plane`, counted from the plane where rays start. After its last plane the pattern of moves
  /// repeats. Rays without fractional moves (movesU and movesV empty) continue straight instead.
  PlaneCrossing Crossing(int plane) const;
  /// Whether rays always move along u and v at once, i.e. both tangents and both starts are equal.
  bool MovesBothWaysAtOnce() const;
};

/// Number of planes after which the ray pattern along an axis of `size` voxels repeats: `size`, or a multiple of it for
/// a short periodic axis, whose rays wrap around.
int PlanesOfPattern(int size, bool periodic);

/// Marching axes of a direction: the axis whose voxel planes it crosses most often per unit length, so that its rays
/// never move sideways by more than one voxel per plane. If several axes are equal in this respect, each gets an equal
/// fraction of the power.
std::vector<int> MarchingAxes(const Grid& grid, const std::array<double, 3>& omega);

/// Fraction of a direction's power that marches along `axis`: 0 or 1, or 1/2 or 1/3 if several axes share the power.
double PartMarching(const Grid& grid, const std::array<double, 3>& omega, int axis);

/// Position within a voxel of the first plane where the rays of a bundle start. With mapResolution above 1: position
/// within each of the mapResolution x mapResolution cells into which the voxel's face is divided.
enum class RayStarts
{
  Middle, ///< middle of the voxel, for all bundles
  /// A different position for each bundle, so that errors at the box's sides average out over the bundles.
  Staggered,
  /// Two rays per voxel (if mapResolution is 1), at the nodes of the two-point Gauss rule across the voxel, in opposite
  /// order along u and v. In an optically thick voxel, a single ray in the middle corresponds to the midpoint rule
  /// across the voxel, with an error of 1/24 of the square of the optical thickness. The error of two rays is of fourth
  /// order in the optical thickness.
  Pairs
};

/// Bundles (directions whose segments have the same lengths) of all directions of `set` that march along `axis`,
/// forward and backward, with mapResolution x mapResolution rays per voxel and direction; two rays with
/// RayStarts::Pairs if mapResolution is 1.
std::vector<Bundle> BundlesAlong(int axis, const Grid& grid, const std::array<bool, 3>& periodic,
  const DirectionSet& set, int mapResolution, RayStarts starts = RayStarts::Middle);

/// Bundles for one collimated beam: one for each of the mapResolution^2 positions in a voxel at which rays start. Each
/// bundle has one member. If the beam marches forward along the axis, Member::direction is 0 and Member::opposite -1,
/// otherwise the reverse. Bundle::power is the power of a ray per irradiance of the beam, length^2.
std::vector<Bundle> BeamAlong(int axis, const Grid& grid, const std::array<bool, 3>& periodic,
  const std::array<double, 3>& omega, int mapResolution);

/// Copies of `bundles` with only those members (directions) that are lit and march one way along the axis (0 forward, 1
/// backward). Bundles without such members are omitted.
std::vector<Bundle> LitRays(const std::vector<Bundle>& bundles, int way, const std::function<bool(int)>& isLit);

/// Number of rays of all bundles per voxel, forward and backward.
int CountRays(const std::vector<Bundle>& bundles);
}
