#include "LightPropagation/Uncollided/Lamps/LampPyramids.h"

#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tyndall
{
namespace
{
constexpr double RightAngle = 0.5 * Pi;
constexpr int BeamsAcrossCone = 16; ///< minimum number of beams across a spot's cone
/// Length of the first pass along a periodic axis, as a multiple of the box's longest edge in voxels.
constexpr int FirstReach = 2;
constexpr int Farther = 4;             ///< factor by which each further pass reaches farther
constexpr int BeamsAtLeast = 16;       ///< minimum number of beams along an edge of a pyramid on a periodic axis
constexpr double BeamsPerVoxel = 64.0; ///< approximate number of beams that cross each voxel in a pass

/// Number of adjacent beams between two tangents.
/// @param far  number of layers from the lamp to where beams are `width` voxels wide
int BeamsBetween(const std::array<double, 2>& tangents, double far, double width)
{
  // 1e-6 prevents rounding errors from adding a beam.
  return static_cast<int>(std::ceil((tangents[1] - tangents[0]) * far / width - 1e-6));
}

bool IsEmpty(const std::array<double, 2>& range)
{
  return range[0] >= range[1];
}

/// Grid of adjacent beams in a pyramid: ranges of tangents along u and v, and numbers of beams.
struct BeamGrid
{
  std::array<double, 2> u, v;
  int countU, countV;
};

/// Projection of a spot's cone onto the plane of a pyramid's axis and one lateral axis. The planes that touch the cone
/// and contain the third axis are rotated by asin(sin(half angle) / R) from the cone's axis, where R is the length of
/// the projection of the cone's unit axis vector onto the plane.
struct ConeInPlane
{
  ConeInPlane(double forward, double aside, double sine)
    : hasSides(sine < std::hypot(forward, aside))
    , turn(std::atan2(aside, forward))
    , reach(hasSides ? std::asin(sine / std::hypot(forward, aside)) : Pi)
  {
  }

  bool hasSides; ///< whether the cone's projection has two bounding lines; false: it covers all angles
  double turn, reach;
};

/// Weights of the axes, which define the borders of the pyramids: a ray belongs to the axis along which its weighted
/// component, in voxels, is largest. For a distant lamp the weights are such that the whole box is in one pyramid,
/// because beams leave uneven gaps where two pyramids meet.
std::array<double, 3> WeightsOfAxes(const Grid& grid, const glm::dvec3& position)
{
  // Largest tangent of a widened pyramid: its beams move sideways by 0.75 voxels per step of half a layer, which must
  // be below 1.
  constexpr double widest = 1.5;
  double least = widest;
  std::array<double, 3> weights = { 1.0, 1.0, 1.0 };
  for (int axis = 0; axis < 3; ++axis)
  {
    const double near = std::max(-position[axis], position[axis] - grid.size[axis]);
    double aside = 0.0;
    for (int k = 1; k <= 2; ++k)
    {
      const double place = position[(axis + k) % 3];
      aside = std::max({ aside, std::abs(place), std::abs(grid.size[(axis + k) % 3] - place) });
    }
    if (near > 0.0 && aside <= least * near)
    {
      least = aside / near;
      weights = { 1.0, 1.0, 1.0 };
      weights[axis] = widest;
    }
  }
  return weights;
}

/// Pyramid of beams along one sense of an axis. Tangents along the k-th axis after the pyramid's axis (k = 1, 2) are
/// lateral voxels per layer, relative to `Base`. For a narrow cone, `Base` is the tangent of the cone's axis, so that
/// tangents are precise however narrow the cone is; otherwise it is 0.
class Pyramid
{
public:
  Pyramid(const Grid& grid, const std::array<bool, 3>& periodic, const Light& light, const glm::dvec3& position,
    int axis, bool up, double reach = std::numeric_limits<double>::infinity())
    : Axis(axis)
    , Up(up)
    , TheGrid(grid)
    , Periodic(periodic)
    , Position(position)
    , Near(std::max(0.0, up ? -position[axis] : position[axis] - grid.size[axis]))
    , Far(up ? grid.size[axis] - position[axis] : position[axis])
    , Reach(reach / grid.spacing[axis])
  {
    const std::array<double, 3> weights = WeightsOfAxes(grid, position);
    this->Widest = { weights[axis] / weights[(axis + 1) % 3], weights[axis] / weights[(axis + 2) % 3] };
    if (light.type != LightType::Spot)
    {
      return;
    }
    const ConeInPlane first = this->ConeAlong(1, light), second = this->ConeAlong(2, light);
    this->HasBase = IsNarrow(first) && IsNarrow(second);
    if (this->HasBase)
    {
      this->Base = { std::tan(first.turn) * this->PerLayer(1), std::tan(second.turn) * this->PerLayer(2) };
    }
  }

  bool IsThere(const Pass& pass) const
  {
    const bool around = this->Periodic[this->Axis];
    return (this->Far > 0.0 || (around && this->Far == 0.0)) && (pass.begin == 0 || around) && this->Near < this->Reach;
  }

  /// Range of tangents of the beams that are still in the box in this pass, along the k-th axis after the pyramid's
  /// axis. A pass traces beams in a range of layers.
  std::array<double, 2> Seen(int k, const Light& light, const Pass& pass) const
  {
    const int aside = (this->Axis + k) % 3;
    std::array<double, 2> seen = this->Box(k);
    if (pass.begin > 0 && !this->Periodic[aside])
    {
      const double depth = this->Near + pass.begin, low = -this->Position[aside];
      seen = { std::max(seen[0], low / depth - this->Base[k - 1]),
        std::min(seen[1], (this->TheGrid.size[aside] + low) / depth - this->Base[k - 1]) };
    }
    if (light.type == LightType::Spot)
    {
      const std::array<double, 2> cone = this->Cone(k, light);
      // Margin between the outermost edges of the beams and the border of the cone
      const double aroundIt = 0.01 * (cone[1] - cone[0]);
      seen = { std::max(seen[0], cone[0] - aroundIt), std::min(seen[1], cone[1] + aroundIt) };
    }
    return seen;
  }

  /// Whether the beams cover all of the part of a spot's cone in this pyramid.
  bool SeesAllOfCone(const Light& spot) const
  {
    bool isThere = true, seesAll = this->Far > 0.0;
    for (int k = 1; k <= 2; ++k)
    {
      const double base = this->Base[k - 1], widest = this->Widest[k - 1];
      const std::array<double, 2> cone = this->Cone(k, spot), box = this->Box(k);
      const std::array<double, 2> part = { std::max(cone[0], -widest - base), std::min(cone[1], widest - base) };
      isThere = isThere && !IsEmpty(part);
      seesAll = seesAll && box[0] <= part[0] && part[1] <= box[1];
    }
    return seesAll || !isThere;
  }

  BeamRow Row(const BeamGrid& beams, int number, const Light& light, const Pass& pass) const
  {
    const double width[] = { (beams.u[1] - beams.u[0]) / beams.countU, (beams.v[1] - beams.v[0]) / beams.countV };
    const double middle[] = { beams.u[0] + 0.5 * width[0], beams.v[0] + (number + 0.5) * width[1] };
    const auto start = [&](int k) { // computed in doubles: for a distant lamp both terms are large and nearly cancel
      return static_cast<float>(this->Position[(this->Axis + 1 + k) % 3] + (this->Base[k] + middle[k]) * this->Near);
    };
    const bool outside = this->Near > 0.0;
    const double from = !outside ? this->Position[this->Axis] : this->Up ? 0.0 : this->TheGrid.size[this->Axis];
    BeamRow row = {};
    row.axis = this->Axis;
    row.up = this->Up;
    row.baseU = static_cast<float>(this->Base[0]);
    row.baseV = static_cast<float>(this->Base[1]);
    if (light.type == LightType::Spot && !this->HasBase)
    {
      const std::array<double, 3> along = DirectionOf(light);
      const double layer = (this->Up ? 1.0 : -1.0) * this->TheGrid.spacing[this->Axis];
      row.crossing[1] = static_cast<float>(-layer * along[(this->Axis + 2) % 3]);
      row.crossing[2] = static_cast<float>(layer * along[(this->Axis + 1) % 3]);
    }
    row.tangentU = static_cast<float>(middle[0]);
    row.tangentV = static_cast<float>(middle[1]);
    row.widthU = static_cast<float>(width[0]);
    row.widthV = static_cast<float>(width[1]);
    row.count = beams.countU;
    row.outside = outside;
    row.beside = (this->IsBeside(1) ? 1 : 0) + (this->IsBeside(2) ? 2 : 0);
    row.from = static_cast<float>(from);
    row.startU = start(0);
    row.startV = start(1);
    row.openU = static_cast<float>(width[0] * this->Near);
    row.openV = static_cast<float>(width[1] * this->Near);
    row.skipped = pass.begin;
    row.layers = pass.onlyBefore ? pass.begin : pass.end;
    row.layers = static_cast<cl_int>(std::min(row.layers + 0.0, std::ceil(this->Reach - this->Near) + 1.0));
    row.share = 1.0f;
    return row;
  }

  /// Number of beams along the k-th axis after the pyramid's axis. Each beam is at most `width` voxels wide where it
  /// leaves the box, or where a pass begins.
  int Count(int k, const std::array<double, 2>& seen, const Light& light, const Pass& pass, double width) const
  {
    const int aside = (this->Axis + k) % 3, other = (this->Axis + 3 - k) % 3;
    const std::array<int, 3>& size = this->TheGrid.size;
    int count = light.type == LightType::Spot ? BeamsAcrossCone : 1;
    if (!this->Periodic[this->Axis] || this->Reach < this->Far)
    {
      return std::max(count, BeamsBetween(seen, std::min(this->Far, this->Reach), width));
    }
    count = std::max(count, BeamsAtLeast);
    if (!this->Periodic[aside])
    {
      const double far = pass.begin > 0 ? pass.begin : std::max(this->Far, pass.end / (2.0 * FirstReach));
      return std::max(count, BeamsBetween(seen, far, width));
    }
    if (pass.begin == 0)
    {
      return std::max(count, BeamsBetween(seen, this->Far, width));
    }
    const double ofPlane = BeamsPerVoxel * size[this->Axis] * size[aside] / pass.end;
    const double enough = this->Periodic[other] ? std::sqrt(ofPlane * size[other]) : ofPlane;
    return std::max(count, static_cast<int>(std::min(enough, BeamsBetween(seen, pass.begin, width) + 0.0)));
  }

  const int Axis;
  const bool Up;

private:
  bool IsBeside(int k) const
  {
    const int aside = (this->Axis + k) % 3;
    return this->Position[aside] < 0.0 || this->Position[aside] > this->TheGrid.size[aside];
  }

  /// Whether the tangents on the cone's border differ little from the tangent of the cone's axis. This requires a
  /// narrow cone whose axis is far from normal to the pyramid's axis.
  static bool IsNarrow(const ConeInPlane& cone)
  {
    constexpr double narrow = 0.1;
    return cone.reach < narrow * std::min(1.0, RightAngle - std::abs(cone.turn));
  }

  double PerLayer(int k) const
  {
    return this->TheGrid.spacing[this->Axis] / this->TheGrid.spacing[(this->Axis + k) % 3];
  }

  ConeInPlane ConeAlong(int k, const Light& spot) const
  {
    const std::array<double, 3> along = DirectionOf(spot);
    return { this->Up ? along[this->Axis] : -along[this->Axis], along[(this->Axis + k) % 3],
      std::sin(HalfAngle(spot)) };
  }

  /// Range of tangents, within the pyramid, of rays that meet the box; for a lamp on a face of the box, of all inward
  /// rays.
  std::array<double, 2> Box(int k) const
  {
    const int aside = (this->Axis + k) % 3;
    const double low = -this->Position[aside];
    const double high = this->TheGrid.size[aside] - this->Position[aside];
    const double depth = std::max(this->Near, 1e-9), widest = this->Widest[k - 1];
    if (this->Near == 0.0 && low <= 0.0 && high >= 0.0)
    {
      const bool around = this->Periodic[aside];
      return { (low < 0.0 || around ? -widest : 0.0) - this->Base[k - 1],
        (high > 0.0 || around ? widest : 0.0) - this->Base[k - 1] };
    }
    return { std::max(-widest, std::min(low / depth, low / this->Far)) - this->Base[k - 1],
      std::min(widest, std::max(high / depth, high / this->Far)) - this->Base[k - 1] };
  }

  /// Range of tangents of a spot's cone; the first exceeds the second if the cone is not in the pyramid.
  std::array<double, 2> Cone(int k, const Light& spot) const
  {
    const ConeInPlane cone = this->ConeAlong(k, spot);
    if (HalfAngle(spot) >= RightAngle || !cone.hasSides)
    {
      return { -this->Widest[k - 1], this->Widest[k - 1] };
    }
    if (cone.turn - cone.reach >= RightAngle || cone.turn + cone.reach <= -RightAngle)
    {
      return { 1.0, -1.0 };
    }
    // The tangents are relative to that of the cone's axis: tan a - tan b = sin(a - b) / (cos a cos b) is precise for
    // close angles
    if (this->HasBase)
    {
      const double scale = std::sin(cone.reach) / std::cos(cone.turn) * this->PerLayer(k);
      return { -scale / std::cos(cone.turn - cone.reach), scale / std::cos(cone.turn + cone.reach) };
    }
    const auto tangent = [&](double angle) {
      return std::abs(angle) >= RightAngle ? std::copysign(this->Widest[k - 1], angle)
                                           : std::tan(angle) * this->PerLayer(k);
    };
    return { tangent(cone.turn - cone.reach), tangent(cone.turn + cone.reach) };
  }

  const Grid& TheGrid;
  const std::array<bool, 3>& Periodic;
  const glm::dvec3& Position;
  const double Near, Far; ///< number of layers from the lamp to the box's near face and to its far face
  const double Reach;     ///< maximum number of layers from the lamp to the end of its beams
  std::array<double, 2> Widest = { 1.0, 1.0 }; ///< tangents at which neighbouring pyramids begin, absolute values
  bool HasBase = false;
  std::array<double, 2> Base = {};
};
}

bool SeesAllOfCone(const Grid& grid, const Light& spot, const glm::dvec3& position)
{
  constexpr std::array<bool, 3> open = {};
  bool all = true;
  for (int face = 0; face < 6; ++face)
  {
    all = all && Pyramid(grid, open, spot, position, face / 2, face % 2 == 1).SeesAllOfCone(spot);
  }
  return all;
}

Pass Pass::Next() const
{
  return { this->end, Farther * this->end };
}

Pass FirstPass(const Grid& grid)
{
  return { 0, FirstReach * std::max({ grid.size[0], grid.size[1], grid.size[2] }) };
}

std::vector<BeamRow> Beams(const Grid& grid, const std::array<bool, 3>& periodic, const Light& light,
  const glm::dvec3& position, double width, const Pass& pass, double reach)
{
  std::vector<BeamRow> rows;
  for (int face = 0; face < 6; ++face)
  {
    const Pyramid pyramid(grid, periodic, light, position, face / 2, face % 2 == 1, reach);
    if (!pyramid.IsThere(pass))
    {
      continue;
    }
    BeamGrid beams = { pyramid.Seen(1, light, pass), pyramid.Seen(2, light, pass), 0, 0 };
    if (IsEmpty(beams.u) || IsEmpty(beams.v))
    {
      continue;
    }
    beams.countU = pyramid.Count(1, beams.u, light, pass, width);
    beams.countV = pyramid.Count(2, beams.v, light, pass, width);
    for (int j = 0; j < beams.countV; ++j)
    {
      rows.push_back(pyramid.Row(beams, j, light, pass));
    }
  }
  return rows;
}
}
