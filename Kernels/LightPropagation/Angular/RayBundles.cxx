#include "LightPropagation/Angular/RayBundles.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
/// Distance from a voxel's border, voxels, below which a position counts as on the border, so that rounding does not
/// decide ties.
constexpr double OnBorder = 1e-9;
/// Minimum number of planes of voxels after which the ray pattern along a periodic axis repeats. On a shorter axis it
/// repeats only after rays have crossed the axis several times.
constexpr int FewestPlanes = 128;
/// Smaller node of the Gauss-Legendre rule of two points in (0, 1).
constexpr double GaussNode = 0.21132486540518712;

bool Same(double a, double b)
{
  return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b));
}

double Tangent(const Grid& grid, const std::array<double, 3>& omega, int axis, int aside)
{
  return (omega[aside] / grid.spacing[aside]) / (std::abs(omega[axis]) / grid.spacing[axis]);
}

Bundle EmptyBundle(const PlaneAxes& axes, const Grid& grid, const std::array<double, 3>& omega)
{
  Bundle bundle;
  bundle.tangentU = std::abs(Tangent(grid, omega, axes.axis, axes.u));
  bundle.tangentV = std::abs(Tangent(grid, omega, axes.axis, axes.v));
  bundle.length = grid.spacing[axes.axis] / std::abs(omega[axes.axis]);
  bundle.power = std::abs(omega[axes.axis]) * grid.spacing[axes.u] * grid.spacing[axes.v];
  return bundle;
}

/// Index of the mirror image of a direction in the plane normal to `axis`. Quadratures are symmetric and contain all
/// mirror images.
int MirrorImage(const DirectionSet& set, int direction, int axis)
{
  std::array<double, 3> omega = set.directions[direction].omega;
  omega[axis] = -omega[axis];
  return Nearest(set, omega);
}

int Sign(double x)
{
  return x < 0.0 ? -1 : 1;
}

/// Adds direction `d` to the bundle of directions whose rays have the same segments and power, or to a new bundle.
/// @param part  fraction of the direction's power that marches along this axis
void Sort(
  std::vector<Bundle>& bundles, const PlaneAxes& axes, const Grid& grid, const DirectionSet& set, int d, double part)
{
  const Direction& direction = set.directions[d];
  const std::array<double, 3>& omega = direction.omega;
  Bundle fresh = EmptyBundle(axes, grid, omega);
  fresh.power *= part * direction.weight;
  const bool square = Same(grid.spacing[axes.u], grid.spacing[axes.v]);
  const int signU = Sign(omega[axes.u]);
  const int signV = Sign(omega[axes.v]);
  for (Bundle& bundle : bundles)
  {
    if (!Same(bundle.power, fresh.power))
    {
      continue;
    }
    if (Same(bundle.tangentU, fresh.tangentU) && Same(bundle.tangentV, fresh.tangentV))
    {
      bundle.members.push_back({ d, MirrorImage(set, d, axes.axis), signU, 0, 0, signV });
      return;
    }
    if (square && Same(bundle.tangentU, fresh.tangentV) && Same(bundle.tangentV, fresh.tangentU))
    {
      bundle.members.push_back({ d, MirrorImage(set, d, axes.axis), 0, signU, signV, 0 });
      return;
    }
  }
  fresh.members.push_back({ d, MirrorImage(set, d, axes.axis), signU, 0, 0, signV });
  bundles.push_back(fresh);
}

/// Lets the rays of each bundle (directions whose segments have the same lengths) start at a different position within
/// their voxels. If all rays started in the middle, errors at the box's sides would have the same pattern however many
/// directions there are. The positions follow the low-discrepancy sequence of the plastic number, which fills a square
/// evenly (Roberts 2018). Bundles are in the order of their tangents, so that every marching axis gets the same
/// positions.
void Stagger(std::vector<Bundle>& bundles)
{
  std::vector<Bundle*> inOrder;
  for (Bundle& bundle : bundles)
  {
    inOrder.push_back(&bundle);
  }
  const auto less = [](const Bundle* a, const Bundle* b) {
    return std::minmax(a->tangentU, a->tangentV) < std::minmax(b->tangentU, b->tangentV);
  };
  std::stable_sort(inOrder.begin(), inOrder.end(), less);
  double first = 0.5, second = 0.5;
  for (Bundle* bundle : inOrder)
  {
    // If both tangents are equal, rays start at the same position along u and v, so that no axis has precedence.
    const bool diagonal = Same(bundle->tangentU, bundle->tangentV);
    bundle->startU = diagonal || bundle->tangentU < bundle->tangentV ? first : second;
    bundle->startV = diagonal || bundle->tangentU > bundle->tangentV ? first : second;
    first = std::fmod(first + 0.7548776662466927, 1.0);
    second = std::fmod(second + 0.5698402909980532, 1.0);
  }
}

bool IsMove(const Move& move)
{
  return move.depth <= 1.0;
}

/// A coordinate in voxels, split into an integer and a remainder in [0, 1).
struct Position
{
  double voxel, rest;
  explicit Position(double x)
    : voxel(std::floor(x + OnBorder))
    , rest(std::max(0.0, x - this->voxel))
  {
  }
};

/// Move by which a straight ray, with all of its power, changes its column of voxels in plane `plane` of voxels; no
/// move if it stays in its column.
Move WholeMove(double start, double tangent, int plane)
{
  const Position now(start + tangent * plane);
  const Position next(start + tangent * (plane + 1));
  return next.voxel > now.voxel ? Move{ std::min(1.0, (1.0 - now.rest) / tangent), 1.0 } : Move();
}

/// Index of the plane of voxels that contains a depth, which is counted in planes from the start of the ray. A depth at
/// the border of two planes belongs to the first of them.
int PlaneAt(double depth)
{
  return std::max(static_cast<int>(std::ceil(depth - OnBorder)) - 1, 0);
}

/// Adds a sideways move of rays at `depth`, counted in planes of voxels from the start. If its plane already has a
/// move, the earlier move is shifted to the end of the previous plane.
void Insert(std::vector<Move>& moves, double depth, double part)
{
  int plane = std::min(PlaneAt(depth), static_cast<int>(moves.size()) - 1);
  Move move = { std::min(depth - plane, 1.0), part };
  while (plane >= 0 && IsMove(moves[plane]))
  {
    std::swap(moves[plane], move);
    move.depth = 1.0;
    --plane;
  }
  if (plane >= 0)
  {
    moves[plane] = move;
    return;
  }
  // If all previous planes have a move, moves are shifted towards the next plane without a move.
  const auto free = std::find_if_not(moves.begin(), moves.end(), IsMove);
  if (free != moves.end())
  {
    std::rotate(moves.begin(), free, free + 1);
    moves.front() = move;
  }
}

/// Sideways moves along one axis, by plane of voxels, of rays that start at `start` in their voxel and move by
/// `tangent` voxels per plane. Over all planes they move by tangent x planes voxels: the integer part as moves of a
/// ray's complete power, the remainder as one move of that fraction of the power (numerics.md, Eq. (21)).
std::vector<Move> Moves(double start, double tangent, int planes)
{
  std::vector<Move> moves(planes);
  const double all = tangent * planes;
  if (all < OnBorder)
  {
    return moves;
  }
  const int whole = static_cast<int>(std::ceil(all - OnBorder)) - 1;
  const double part = std::min(all - whole, 1.0);
  const auto wholeAt = [&](int k, double more) { return (k + more - start) / tangent; };
  const auto partAt = [&](int before) { return (before + part * (1.0 - start)) / tangent; };
  // The fractional move is placed as late as possible, but such that no plane has two moves.
  const auto hasRoom = [&](int before) {
    const int plane = PlaneAt(partAt(before));
    return (before == 0 || PlaneAt(wholeAt(before, 0.0)) < plane) &&
      (before == whole || plane < PlaneAt(wholeAt(before + 1, part)));
  };
  int before = whole;
  while (before > 0 && !hasRoom(before))
  {
    --before;
  }
  before = hasRoom(before) ? before : whole;
  for (int k = 1; k <= whole; ++k)
  {
    Insert(moves, wholeAt(k, k > before ? part : 0.0), 1.0);
  }
  Insert(moves, partAt(before), part);
  return moves;
}

/// Adds to a bundle the sideways moves of its rays along u and v, unless both axes are periodic. If only one axis is
/// periodic, moves along both are needed, because u and v are exchanged for some members (directions) of the bundle.
void AddMoves(Bundle& bundle, const PlaneAxes& axes, const std::array<bool, 3>& periodic, int planes)
{
  if (!periodic[axes.u] || !periodic[axes.v])
  {
    bundle.movesU = Moves(bundle.startU, bundle.tangentU, planes);
    bundle.movesV = Moves(bundle.startV, bundle.tangentV, planes);
  }
}

/// Copies of a bundle of directions: one for each position in a voxel at which rays start. There are mapResolution x
/// mapResolution positions.
std::vector<Bundle> OnLattice(const Bundle& bundle, int mapResolution)
{
  std::vector<Bundle> all;
  for (int j = 0; j < mapResolution; ++j)
  {
    for (int i = 0; i < mapResolution; ++i)
    {
      Bundle shifted = bundle;
      shifted.startU = (i + bundle.startU) / mapResolution;
      shifted.startV = (j + bundle.startV) / mapResolution;
      shifted.power /= static_cast<double>(mapResolution) * mapResolution;
      all.push_back(shifted);
    }
  }
  return all;
}

/// Two copies of a bundle, for the two rays per voxel of RayStarts::Pairs.
std::vector<Bundle> InPairs(const Bundle& bundle)
{
  std::vector<Bundle> pair(2, bundle);
  for (int i = 0; i < 2; ++i)
  {
    pair[i].startU = i == 0 ? GaussNode : 1.0 - GaussNode;
    pair[i].startV = 1.0 - pair[i].startU;
    pair[i].power /= 2.0;
  }
  return pair;
}

/// Copies of each bundle of directions for all positions in a voxel where rays start, with the sideways moves of these
/// rays.
std::vector<Bundle> RaysOf(const std::vector<Bundle>& bundles, const PlaneAxes& axes, const Grid& grid,
  const std::array<bool, 3>& periodic, int mapResolution, RayStarts starts)
{
  const int planes = PlanesOfPattern(grid.size[axes.axis], periodic[axes.axis]);
  const bool pairs = starts == RayStarts::Pairs && mapResolution == 1;
  std::vector<Bundle> all;
  for (const Bundle& bundle : bundles)
  {
    std::vector<Bundle> inVoxel = pairs ? InPairs(bundle) : OnLattice(bundle, mapResolution);
    for (Bundle& rays : inVoxel)
    {
      AddMoves(rays, axes, periodic, planes);
      all.push_back(std::move(rays));
    }
  }
  return all;
}
}

bool Bundle::MovesBothWaysAtOnce() const
{
  return Same(this->tangentU, this->tangentV) && Same(this->startU, this->startV);
}

/// Moves along u and v are combined if both tangents and both starting positions are equal. If other moves are at the
/// same depth, the move along the axis with the larger tangent comes first, so that the result does not depend on the
/// bundle's orientation.
PlaneCrossing Bundle::Crossing(int plane) const
{
  const auto moveAt = [plane](const std::vector<Move>& moves, double start, double tangent) {
    return moves.empty() ? WholeMove(start, tangent, plane) : moves[static_cast<std::size_t>(plane) % moves.size()];
  };
  const Move u = moveAt(this->movesU, this->startU, this->tangentU);
  const Move v = moveAt(this->movesV, this->startV, this->tangentV);
  const bool tie = std::abs(u.depth - v.depth) < OnBorder;
  const bool uFirst = tie ? this->tangentU > this->tangentV : u.depth < v.depth;
  PlaneCrossing crossing;
  double depth = 0.0;
  const auto cross = [&](const Move& move, int moveU, int moveV) {
    if (!IsMove(move))
    {
      return;
    }
    crossing.segments[crossing.count - 1].length = std::max(0.0, move.depth - depth) * this->length;
    crossing.segments[crossing.count] = { moveU, moveV, move.part, 0.0 };
    ++crossing.count;
    depth = move.depth;
  };
  if (this->MovesBothWaysAtOnce())
  {
    cross(u, 1, 1);
  }
  else
  {
    cross(uFirst ? u : v, uFirst ? 1 : 0, uFirst ? 0 : 1);
    cross(uFirst ? v : u, uFirst ? 0 : 1, uFirst ? 1 : 0);
  }
  crossing.segments[crossing.count - 1].length = std::max(0.0, 1.0 - depth) * this->length;
  return crossing;
}

int PlanesOfPattern(int size, bool periodic)
{
  return periodic ? (FewestPlanes + size - 1) / size * size : size;
}

std::vector<int> MarchingAxes(const Grid& grid, const std::array<double, 3>& omega)
{
  std::array<double, 3> crossings; // planes crossed per unit length
  for (int axis = 0; axis < 3; ++axis)
  {
    crossings[axis] = std::abs(omega[axis]) / grid.spacing[axis];
  }
  const double most = *std::max_element(crossings.begin(), crossings.end());
  std::vector<int> axes;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (crossings[axis] >= (1.0 - OnBorder) * most)
    {
      axes.push_back(axis);
    }
  }
  return axes;
}

double PartMarching(const Grid& grid, const std::array<double, 3>& omega, int axis)
{
  const std::vector<int> axes = MarchingAxes(grid, omega);
  const bool marches = std::find(axes.begin(), axes.end(), axis) != axes.end();
  return marches ? 1.0 / static_cast<double>(axes.size()) : 0.0;
}

std::vector<Bundle> BundlesAlong(int axis, const Grid& grid, const std::array<bool, 3>& periodic,
  const DirectionSet& set, int mapResolution, RayStarts starts)
{
  const PlaneAxes axes = AcrossAxis(axis);
  std::vector<Bundle> bundles;
  for (std::size_t d = 0; d < set.directions.size(); ++d)
  {
    const std::array<double, 3>& omega = set.directions[d].omega;
    const double part = PartMarching(grid, omega, axis);
    if (part > 0.0 && omega[axis] > 0.0)
    {
      Sort(bundles, axes, grid, set, static_cast<int>(d), part);
    }
  }
  if (starts == RayStarts::Staggered)
  {
    Stagger(bundles);
  }
  return RaysOf(bundles, axes, grid, periodic, mapResolution, starts);
}

std::vector<Bundle> BeamAlong(int axis, const Grid& grid, const std::array<bool, 3>& periodic,
  const std::array<double, 3>& omega, int mapResolution)
{
  const PlaneAxes axes = AcrossAxis(axis);
  Bundle beam = EmptyBundle(axes, grid, omega);
  const bool forward = omega[axis] > 0.0;
  beam.members.push_back({ forward ? 0 : -1, forward ? -1 : 0, Sign(omega[axes.u]), 0, 0, Sign(omega[axes.v]) });
  return RaysOf({ beam }, axes, grid, periodic, mapResolution, RayStarts::Middle);
}

std::vector<Bundle> LitRays(const std::vector<Bundle>& bundles, int way, const std::function<bool(int)>& isLit)
{
  std::vector<Bundle> lit;
  for (Bundle bundle : bundles)
  {
    std::vector<Member> members;
    for (Member member : bundle.members)
    {
      int& other = way == 0 ? member.opposite : member.direction;
      const int direction = way == 0 ? member.direction : member.opposite;
      other = -1;
      if (direction >= 0 && isLit(direction))
      {
        members.push_back(member);
      }
    }
    bundle.members.swap(members);
    if (!bundle.members.empty())
    {
      lit.push_back(bundle);
    }
  }
  return lit;
}

int CountRays(const std::vector<Bundle>& bundles)
{
  int rays = 0;
  for (const Bundle& bundle : bundles)
  {
    for (const Member& member : bundle.members)
    {
      rays += (member.direction >= 0 ? 1 : 0) + (member.opposite >= 0 ? 1 : 0);
    }
  }
  return rays;
}
}
