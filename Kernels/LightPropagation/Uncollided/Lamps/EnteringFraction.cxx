#include "LightPropagation/Uncollided/Lamps/LampOnGrid.h"

#include "LightPropagation/Uncollided/Lamps/LampPoints.h"
#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tyndall
{
namespace
{
/// Maximum distance between a rectangle and the box at which the contour integral is accurate in double precision, as a
/// multiple of the geometric mean of the longest edges of rectangle and box.
constexpr double Farthest = 1e4;

/// Fraction of the light of a point lamp that enters the box. Inside the box: 1. Outside: from the solid angles of the
/// faces that the lamp sees. On the boundary: the fraction that is emitted inwards.
double OfPoint(const Grid& grid, const glm::dvec3& place, const std::array<bool, 3>& periodic)
{
  double angle = 0.0, onFaces = 1.0;
  bool outside = false;
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto reach = [&](int a, double end) { return (end - place[a]) * grid.spacing[a]; };
    const double near = face % 2 ? -reach(axis, grid.size[axis]) : reach(axis, 0.0);
    onFaces *= near == 0.0 && !periodic[axis] ? 0.5 : 1.0;
    if (near <= 0.0)
    {
      continue;
    }
    outside = true;
    for (int corner = 0; corner < 4; ++corner)
    {
      const double a = reach(u, corner & 1 ? grid.size[u] : 0.0), b = reach(v, corner & 2 ? grid.size[v] : 0.0);
      const double seen = std::atan2(a * b, near * std::sqrt(a * a + b * b + near * near));
      angle += corner == 0 || corner == 3 ? seen : -seen;
    }
  }
  return outside ? angle / (4.0 * Pi) : onFaces;
}

/// Corners of a face of the box, relative to `from`, lengths.
std::array<glm::dvec3, 4> CornersOfFace(const Grid& grid, int face, const glm::dvec3& from)
{
  std::array<glm::dvec3, 4> corners;
  for (int i = 0; i < 4; ++i)
  {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    corners[i][axis] = face % 2 ? grid.Length(axis) : 0.0;
    corners[i][u] = i == 1 || i == 2 ? grid.Length(u) : 0.0;
    corners[i][v] = i >= 2 ? grid.Length(v) : 0.0;
    corners[i] -= from;
  }
  return corners;
}

/// Signed solid angle, sr, of the region between a cone's axis and the arc from a to b, inside the cone. All vectors
/// are unit vectors.
/// @param half  half angle of the cone
double AngleInCone(const glm::dvec3& axis, double half, const glm::dvec3& a, const glm::dvec3& b)
{
  const glm::dvec3 across = glm::cross(glm::cross(a, b), a);
  const double end = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)), aside = glm::length(across);
  if (!(aside > 0.0))
  {
    return 0.0;
  }
  const glm::dvec3 t = across / aside;
  const double most = std::hypot(glm::dot(axis, a), glm::dot(axis, t)), cosine = std::cos(half);
  // Position on the arc closest to the axis
  const double middle = std::atan2(glm::dot(axis, t), glm::dot(axis, a));
  const double reach = std::acos(std::clamp(most > 0.0 ? cosine / most : cosine * 1e300, -1.0, 1.0));
  std::vector<double> cuts = { 0.0, end };
  for (const double cut : { middle - reach, middle + reach, middle - reach + 2.0 * Pi, middle + reach - 2.0 * Pi })
  {
    cuts.push_back(std::clamp(cut, 0.0, end));
  }
  std::sort(cuts.begin(), cuts.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
  {
    const auto at = [&](double s) { return std::cos(s) * a + std::sin(s) * t; };
    const glm::dvec3 from = at(cuts[i]), to = at(cuts[i + 1]);
    const double volume = glm::dot(axis, glm::cross(from, to)), x = glm::dot(axis, from), y = glm::dot(axis, to);
    const bool inside = glm::dot(axis, at(0.5 * (cuts[i] + cuts[i + 1]))) > cosine;
    sum += inside ? 2.0 * std::atan2(volume, 1.0 + x + y + glm::dot(from, to))
                  : 2.0 * std::pow(std::sin(0.5 * half), 2.0) * std::atan2(volume, glm::dot(from, to) - x * y);
  }
  return sum;
}

/// Fraction of the light of a spot outside the box that enters the box; 0 if unknown, because the spot is not outside
/// or its cone is too narrow for double precision.
double OfSpot(const Grid& grid, const Light& spot, const glm::dvec3& place)
{
  constexpr double narrow = 1e-6;
  const double half = HalfAngle(spot), all = 4.0 * Pi * std::pow(std::sin(0.5 * half), 2.0);
  double angle = 0.0;
  for (int face = 0; face < 6 && half > narrow; ++face)
  {
    const double near = face % 2 ? place[face / 2] - grid.size[face / 2] : -place[face / 2];
    if (near <= 0.0)
    {
      continue;
    }
    const std::array<glm::dvec3, 4> corners = CornersOfFace(grid, face, place * Vector(grid.spacing));
    double seen = 0.0;
    for (int i = 0; i < 4; ++i)
    {
      seen +=
        AngleInCone(Vector(DirectionOf(spot)), half, glm::normalize(corners[i]), glm::normalize(corners[(i + 1) % 4]));
    }
    seen = face % 2 ? -seen : seen; // solid angle as seen from outside the box
    // A negative sum means that the face encloses the direction opposite to the cone's axis; the cone's solid angle is
    // then added
    angle += seen < -1e-9 * all ? seen + all : seen;
  }
  return angle / all;
}

/// Part of the polygon where normal . x >= least.
Polygon Clip(const Polygon& polygon, const glm::dvec3& normal, double least)
{
  return Clipped(polygon, [&](const glm::dvec3& x) { return glm::dot(x, normal) - least; });
}

double SizeOf(const Polygon& polygon)
{
  glm::dvec3 sum(0.0);
  for (std::size_t i = 2; i < polygon.size(); ++i)
  {
    sum += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return 0.5 * glm::length(sum);
}

struct Edge
{
  glm::dvec3 from, way;
};

Edge EdgeOf(const Polygon& polygon, std::size_t i)
{
  return { polygon[i], polygon[(i + 1) % polygon.size()] - polygon[i] };
}

/// Integral of ln |point - x| over x along an edge, in closed form.
double LogarithmAlong(const Edge& edge, const glm::dvec3& point)
{
  const double length = glm::length(edge.way);
  const glm::dvec3 to = point - edge.from;
  const double along = glm::dot(to, edge.way) / length, aside = glm::length(to - along / length * edge.way);
  const auto upTo = [aside](double t) {
    const double square = t * t + aside * aside;
    return (square > 0.0 ? 0.5 * t * std::log(square) : 0.0) - t + (aside > 0.0 ? aside * std::atan(t / aside) : 0.0);
  };
  return upTo(length - along) - upTo(-along);
}

/// Integral of ln |x - y| dx . dy over two edges. The integral over the second edge uses the tanh-sinh rule, on
/// intervals that end where the second edge is near the first.
double LogarithmOver(const Edge& first, const Edge& second)
{
  constexpr double step = 0.18;
  constexpr int steps = 17;
  const double square = glm::dot(second.way, second.way), length = glm::length(first.way);
  const double dot = glm::dot(first.way, second.way);
  if (std::abs(dot) <= 1e-12 * length * std::sqrt(square))
  {
    return 0.0;
  }
  const glm::dvec3 to = first.from - second.from, normal = glm::cross(second.way, first.way);
  std::array<double, 5> ends = { 0.0, glm::dot(to, second.way) / square, glm::dot(to + first.way, second.way) / square,
    1.0, 1.0 };
  const double slant = glm::dot(normal, normal);
  ends[4] = slant > 1e-12 * square * length * length ? glm::dot(glm::cross(to, first.way), normal) / slant : 1.0;
  for (double& end : ends)
  {
    end = std::clamp(end, 0.0, 1.0);
  }
  std::sort(ends.begin(), ends.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
  {
    const double wide = ends[i + 1] - ends[i];
    for (int k = -steps; k <= steps && wide > 1e-12; ++k)
    {
      const double at = 1.0 / (1.0 + std::exp(-Pi * std::sinh(k * step)));
      const double weight = step * Pi * std::cosh(k * step) * at * (1.0 - at);
      sum += wide * weight * LogarithmAlong(first, second.from + (ends[i] + wide * at) * second.way);
    }
  }
  return sum * dot / length;
}

/// Integral of cos cos / (pi r^2) over two polygons that face each other, by Stokes's theorem: contour integrals around
/// both (numerics.md, Eq. (33c)).
double FormFactor(const Polygon& first, const Polygon& second)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i)
  {
    for (std::size_t j = 0; j < second.size(); ++j)
    {
      const Edge a = EdgeOf(first, i), b = EdgeOf(second, j);
      sum += glm::length(a.way) > 0.0 && glm::length(b.way) > 0.0 ? LogarithmOver(a, b) : 0.0;
    }
  }
  return std::abs(sum) / (2.0 * Pi);
}

/// Fraction of the light of a rectangular lamp that enters the box. The part of the rectangle inside the box
/// contributes all of its light; the part beyond each face contributes the light that it emits through that face.
double OfRectangle(const Grid& grid, const RectangleArea& area, const glm::dvec3& normal)
{
  const glm::dvec3 end = EndOf(grid);
  const Polygon corners = area.Corners();
  Polygon inside = corners;
  double through = 0.0;
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2;
    const double onIt = OnBorder * end[axis], at = face % 2 ? end[axis] : 0.0;
    glm::dvec3 out(0.0);
    out[axis] = face % 2 ? 1.0 : -1.0;
    inside = Clip(inside, -out, -out[axis] * at - onIt);
    const Polygon beyond = Clip(corners, out, out[axis] * at);
    double farthest = 0.0;
    for (const glm::dvec3& corner : beyond)
    {
      farthest = std::max(farthest, out[axis] * (corner[axis] - at));
    }
    if (farthest <= onIt)
    {
      const bool onFace = !beyond.empty() && SizeOf(beyond) > (1.0 - 1e-9) * area.Size();
      inside = onFace && glm::dot(out, normal) > 0.0 ? Polygon() : inside;
      continue;
    }
    const std::array<glm::dvec3, 4> ofFace = CornersOfFace(grid, face, glm::dvec3(0.0));
    through += FormFactor(beyond, Clip({ ofFace.begin(), ofFace.end() }, normal, glm::dot(area.middle, normal)));
  }
  return (SizeOf(inside) + through) / area.Size();
}

/// Distance between a rectangle and the box, by alternating projection, lengths.
double DistanceToBox(const RectangleArea& area, const Grid& grid)
{
  glm::dvec3 at = area.middle, inBox = at;
  for (int i = 0; i < 100; ++i)
  {
    inBox = glm::clamp(at, glm::dvec3(0.0), EndOf(grid));
    at = area.middle;
    for (const glm::dvec3& half : area.half)
    {
      at += half * std::clamp(glm::dot(inBox - area.middle, half) / glm::dot(half, half), -1.0, 1.0);
    }
  }
  return glm::distance(at, inBox);
}
}

double EnteringFraction(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic)
{
  const glm::dvec3 place = PlaceOf(grid, Vector(light.position));
  if (light.type == LightType::Point)
  {
    return OfPoint(grid, place, periodic);
  }
  if (light.type == LightType::Spot)
  {
    return OfSpot(grid, light, place);
  }
  const RectangleArea area(light, grid);
  const glm::dvec3 end = EndOf(grid);
  const double box = std::max({ end.x, end.y, end.z });
  const bool isNear = DistanceToBox(area, grid) < Farthest * std::sqrt(area.Longer() * box);
  return isNear ? OfRectangle(grid, area, Vector(DirectionOf(light))) : 0.0;
}
}
