#include "LightPropagation/Uncollided/Lamps/LampPyramids.h"

#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr int BeamsAcrossCone = 16; ///< of a spot, at least
constexpr int FirstReach = 2;    ///< longest edges of the box, in voxels, that beams go along a periodic axis at first
constexpr int Farther = 4;       ///< times as far in each pass after that
constexpr int BeamsAtLeast = 16; ///< along an edge of a pyramid that goes round a periodic axis
constexpr double BeamsPerVoxel = 64.0; ///< that cross it in a pass, about

/// Smallest and largest tangent (voxels along `aside` per layer) at which the box is seen from `position` between two
/// depths, within the pyramid.
std::array<double, 2> Tangents(const Grid& grid, const glm::dvec3& position, int aside, double near, double far)
{
  const double low = -position[aside];
  const double high = grid.size[aside] - position[aside];
  const double depth = std::max(near, 1e-9);
  return { std::max(-1.0, std::min(low / depth, low / far)), std::min(1.0, std::max(high / depth, high / far)) };
}

/// Tangents (voxels along `aside` per layer) between which a spot's cone is seen in the pyramid along `axis`. The
/// planes that touch the cone and hold the third axis are turned by asin(sin(half angle) / R) from its middle, R the
/// length of that in the plane of the two axes. The first is larger than the second where the cone is not seen there.
std::array<double, 2> TangentsOfCone(const Grid& grid, int axis, bool up, int aside, const Light& light)
{
  constexpr double rightAngle = 0.5 * Pi;
  constexpr double margin = 1e-6; // rounding must not cut the cone
  const glm::dvec3 middle = glm::normalize(Vector(light.direction));
  const double forward = up ? middle[axis] : -middle[axis];
  const double half = 0.5 * light.angle * Pi / 180.0;
  const double inPlane = std::hypot(forward, middle[aside]);
  if (half >= rightAngle || std::sin(half) >= inPlane)
  {
    return { -1.0, 1.0 };
  }
  const double turn = std::atan2(middle[aside], forward);
  const double reach = std::asin(std::sin(half) / inPlane) + margin;
  if (turn - reach >= rightAngle || turn + reach <= -rightAngle)
  {
    return { 1.0, -1.0 };
  }
  const auto tangent = [&](double angle) {
    return std::abs(angle) >= rightAngle ? std::copysign(1.0, angle)
                                         : std::tan(angle) * grid.spacing[axis] / grid.spacing[aside];
  };
  const double low = tangent(turn - reach), high = tangent(turn + reach);
  const double aroundIt = 0.01 * (high - low); // beams' edges do not fall on the cone's
  return { std::max(low - aroundIt, -1.0), std::min(high + aroundIt, 1.0) };
}

/// How many beams lie beside each other between two tangents.
/// @param far  layers to where they are to be `width` voxels wide
int BeamsBetween(const std::array<double, 2>& tangents, double far, double width)
{
  return static_cast<int>(std::ceil((tangents[1] - tangents[0]) * far / width - 1e-6)); // rounding decides on no more
}

/// The pyramid of beams along one axis.
class Pyramid
{
public:
  Pyramid(const Grid& grid, const std::array<bool, 3>& periodic, const glm::dvec3& position, int axis, bool up)
    : TheGrid(grid)
    , Periodic(periodic)
    , Position(position)
    , Axis(axis)
    , Up(up)
    , Near(std::max(0.0, up ? -position[axis] : position[axis] - grid.size[axis]))
    , Far(up ? grid.size[axis] - position[axis] : position[axis])
  {
  }

  bool IsThere(const Pass& pass) const { return this->Far > 0.0 && (pass.begin == 0 || this->Periodic[this->Axis]); }

  /// Tangents along the k-th axis after this one, of beams that are still in the box in a pass.
  std::array<double, 2> Seen(int k, const Light& light, const Pass& pass) const
  {
    const int aside = (this->Axis + k) % 3;
    std::array<double, 2> seen = Tangents(this->TheGrid, this->Position, aside, this->Near, this->Far);
    if (pass.begin > 0 && !this->Periodic[aside])
    {
      seen = { std::max(seen[0], -this->Position[aside] / pass.begin),
        std::min(seen[1], (this->TheGrid.size[aside] - this->Position[aside]) / pass.begin) };
    }
    if (light.type == LightType::Spot)
    {
      const std::array<double, 2> cone = TangentsOfCone(this->TheGrid, this->Axis, this->Up, aside, light);
      seen = { std::max(seen[0], cone[0]), std::min(seen[1], cone[1]) };
    }
    return seen;
  }

  /// Beams along the k-th axis after this one. They are at most `width` voxels wide where they leave the box, or where
  /// a pass begins.
  int Count(int k, const std::array<double, 2>& seen, const Light& light, const Pass& pass, double width) const
  {
    const int aside = (this->Axis + k) % 3, other = (this->Axis + 3 - k) % 3;
    const std::array<int, 3>& size = this->TheGrid.size;
    int count = light.type == LightType::Spot ? BeamsAcrossCone : 1;
    if (!this->Periodic[this->Axis])
    {
      return std::max(count, BeamsBetween(seen, this->Far, width));
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

  const Grid& TheGrid;
  const std::array<bool, 3>& Periodic;
  const glm::dvec3& Position;
  const int Axis;
  const bool Up;
  const double Near, Far; ///< layers from the light to the box and to where it ends
};

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
  const glm::dvec3& position, double width, const Pass& pass)
{
  std::vector<BeamRow> rows;
  for (int face = 0; face < 6; ++face)
  {
    const Pyramid pyramid(grid, periodic, position, face / 2, face % 2 == 1);
    if (!pyramid.IsThere(pass))
    {
      continue;
    }
    const std::array<double, 2> u = pyramid.Seen(1, light, pass), v = pyramid.Seen(2, light, pass);
    if (u[0] >= u[1] || v[0] >= v[1])
    {
      continue;
    }
    const int countU = pyramid.Count(1, u, light, pass, width), countV = pyramid.Count(2, v, light, pass, width);
    for (int j = 0; j < countV; ++j)
    {
      const double widthU = (u[1] - u[0]) / countU;
      const double widthV = (v[1] - v[0]) / countV;
      rows.push_back({ pyramid.Axis, pyramid.Up, static_cast<float>(u[0] + 0.5 * widthU),
        static_cast<float>(v[0] + (j + 0.5) * widthV), static_cast<float>(widthU), static_cast<float>(widthV), countU,
        static_cast<float>(pyramid.Near), pass.begin, pass.end });
    }
  }
  return rows;
}
}
