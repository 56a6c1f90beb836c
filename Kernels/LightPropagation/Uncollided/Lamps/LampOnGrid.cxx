#include "LightPropagation/Uncollided/Lamps/LampOnGrid.h"

#include "Device/Defines.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"
#include "Numerics/Vectors.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tyndall
{
namespace
{
/// A part lights voxels at least this far from its centre, in its radii; for nearer ones it is divided.
constexpr double PartDistance = 2.0;
/// Gauss points along an edge of a square: of a part, and of a rectangle that is not divided
constexpr int PointsOfPart = 2, PointsOfAll = 3;
constexpr double FinestPart = 2.0;   ///< longer edge of the smallest parts, voxels
constexpr double PartsAcross = 64.0; ///< maximum number of smallest parts along the box's longest edge
constexpr double Faint = 0.1;        ///< relative error below which one point represents a part
constexpr std::size_t BeamsTogether = 1 << 18;
/// Periodic images to either side of a rectangle whose light in vacuum is exact; fewer in a box without faces, where
/// light never escapes.
constexpr int ImagesAside = 5, ImagesAsideWithoutFaces = 1;

/// Width of beams where they leave the box, voxels: of a lamp, of a rectangle, of one with many points.
constexpr double BeamWidth = 0.5, BeamWidthOfRectangle = 1.0, BeamWidthOfMany = 1.4;
constexpr std::size_t ManyPoints = 64;
/// Largest distance of a rectangle, in geometric means of its edge and the box's, at which the contour integral is
/// accurate in doubles.
constexpr double Farthest = 1e4;
/// Number of times that the full power may cross one voxel without overflow in fixed point.
constexpr int RoundsAtMost = 64;
/// Fraction of the box's edges: a lamp this near to a face counts as on it, as for photons.
constexpr double OnBorder = 1e-6;

/// Position in voxels from the grid's corner; snapped to a face if next to it.
glm::dvec3 PlaceOf(const Grid& grid, const glm::dvec3& point)
{
  glm::dvec3 place = (point - Vector(grid.origin)) / Vector(grid.spacing);
  for (int a = 0; a < 3; ++a)
  {
    const double size = grid.size[a], end = std::round(place[a] / size) * size;
    place[a] = (end == 0.0 || end == size) && std::abs(place[a] - end) <= OnBorder * size ? end : place[a];
  }
  return place;
}

/// Fraction of a point's light that enters the box: 1 inside; from outside, by the solid angles of the faces that the
/// point sees; on the boundary, the inward part.
double EnteringPart(const Grid& grid, const glm::dvec3& place, const std::array<bool, 3>& periodic)
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

/// Signed solid angle of the region between a cone's axis and the arc from a to b, inside the cone. All vectors are
/// unit vectors.
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
  const double middle = std::atan2(glm::dot(axis, t), glm::dot(axis, a)); // where the arc is closest to the axis
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

/// Fraction of a spot's light that enters the box from outside; 0 if unknown: for a lamp that is not outside, or a cone
/// too narrow for doubles.
double EnteringPart(const Grid& grid, const Light& spot, const glm::dvec3& place)
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
    seen = face % 2 ? -seen : seen;                  // seen from outside
    angle += seen < -1e-9 * all ? seen + all : seen; // the face encloses the direction opposite to the axis
  }
  return angle / all;
}

using Polygon = std::vector<glm::dvec3>; ///< planar and convex

/// The part of the polygon where normal . x >= least.
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

/// Integral of ln |point - x| over x along an edge.
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

/// Integral of ln |x - y| dx . dy over two edges: over the second by the tanh-sinh rule, split where the first one is
/// near.
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
/// both.
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

/// Solid angle of a triangle (van Oosterom, Strackee).
double SolidAngle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
  const double x = glm::length(a), y = glm::length(b), z = glm::length(c);
  return 2.0 *
    std::atan2(std::abs(glm::dot(a, glm::cross(b, c))),
      x * y * z + glm::dot(a, b) * z + glm::dot(b, c) * x + glm::dot(c, a) * y);
}

/// A rectangle, or a part of one. Lengths from the grid's corner.
struct Area
{
  glm::dvec3 middle;
  std::array<glm::dvec3, 2> half; ///< half edge vectors

  Area(const Light& light, const Grid& grid)
    : middle(Vector(light.position) - Vector(grid.origin))
  {
    const std::array<std::array<double, 3>, 2> edges = RectangleEdges(light);
    this->half = { 0.5 * Vector(edges[0]), 0.5 * Vector(edges[1]) };
  }

  double Longer() const { return 2.0 * std::max(glm::length(this->half[0]), glm::length(this->half[1])); }
  double Radius() const { return std::hypot(glm::length(this->half[0]), glm::length(this->half[1])); }
  double Size() const { return 4.0 * glm::length(this->half[0]) * glm::length(this->half[1]); }

  glm::dvec3 At(double a, double b) const { return this->middle + a * this->half[0] + b * this->half[1]; }

  /// Its halves, across the longer edge; quarters if the edges are similar, so that rotated scenes are divided alike.
  std::vector<Area> Parts() const
  {
    constexpr double muchLonger = 1.5;
    const double lengths[] = { glm::length(this->half[0]), glm::length(this->half[1]) };
    const bool first = lengths[0] * muchLonger > lengths[1], second = lengths[1] * muchLonger > lengths[0];
    std::vector<Area> parts;
    for (int i = 0; i < (first ? 2 : 1) * (second ? 2 : 1); ++i)
    {
      Area part = *this;
      part.half[0] *= first ? 0.5 : 1.0;
      part.half[1] *= second ? 0.5 : 1.0;
      const bool upper[] = { i % 2 == 1, first ? i / 2 == 1 : i % 2 == 1 };
      part.middle += (first ? (upper[0] ? 1.0 : -1.0) : 0.0) * part.half[0];
      part.middle += (second ? (upper[1] ? 1.0 : -1.0) : 0.0) * part.half[1];
      parts.push_back(part);
    }
    return parts;
  }

  Polygon Corners() const { return { this->At(-1, -1), this->At(1, -1), this->At(1, 1), this->At(-1, 1) }; }

  /// Gauss points and their weights, `perEdge` along each edge of a square; for an elongated rectangle about as many in
  /// total, more along it and fewer across.
  std::vector<std::pair<glm::dvec3, double>> Points(int perEdge) const
  {
    constexpr int most = 4;
    constexpr double places[][most] = { { 0.0 }, { -0.577350269189626, 0.577350269189626 },
      { -0.774596669241483, 0.0, 0.774596669241483 },
      { -0.861136311594053, -0.339981043584856, 0.339981043584856, 0.861136311594053 } };
    constexpr double shares[][most] = { { 1.0 }, { 0.5, 0.5 }, { 5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0 },
      { 0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727 } };
    const double longer = std::sqrt(glm::length(this->half[0]) / glm::length(this->half[1]));
    const auto along = [=](double stretch) { // rounding must not make rotated scenes differ
      return perEdge == 1 ? 1 : static_cast<int>(std::clamp(perEdge * stretch + 0.5 + 1e-9, 1.0, most + 0.5));
    };
    const int counts[] = { along(longer), along(1.0 / longer) };
    std::vector<std::pair<glm::dvec3, double>> points;
    for (int i = 0; i < counts[0] * counts[1]; ++i)
    {
      const int first = i % counts[0], second = i / counts[0];
      points.push_back({ this->At(places[counts[0] - 1][first], places[counts[1] - 1][second]),
        shares[counts[0] - 1][first] * shares[counts[1] - 1][second] });
    }
    return points;
  }
};

glm::dvec3 EndOf(const Grid& grid)
{
  return { grid.Length(0), grid.Length(1), grid.Length(2) };
}

/// Fraction of a rectangle's light that enters the box: all light of the part inside, and for each face the light
/// through it of the part beyond.
double EnteringPart(const Grid& grid, const Area& area, const glm::dvec3& normal)
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

/// Divides a rectangle into parts: each voxel is lit by parts that are small compared with their distance from it, and
/// that together make up the whole rectangle.
class RectangleParts
{
public:
  RectangleParts(const Grid& grid, const std::array<bool, 3>& periodic, const Light& light)
    : TheGrid(grid)
    , Periodic(periodic)
    , Whole(light, grid)
    , Normal(Vector(DirectionOf(light)))
  {
    const double along = std::max({ grid.size[0], grid.size[1], grid.size[2] });
    const double voxel = std::cbrt(grid.spacing[0] * grid.spacing[1] * grid.spacing[2]);
    this->Finest = FinestPart * voxel * std::max(1.0, along / PartsAcross);
    this->Away = PartDistance * std::max(1.0, 0.5 * light.fineness);
    this->PerEdge = std::max(PointsOfPart, static_cast<int>(light.fineness));
    this->LeastError = Faint / std::pow(light.fineness, 3.0);
    this->Divide(this->Whole, { this->Whole.middle, std::numeric_limits<double>::infinity() });
  }

  std::vector<LampPoint> Points;

private:
  /// Smallest and largest distance of the box's voxels from a point.
  std::array<double, 2> Distances(const glm::dvec3& point) const
  {
    const glm::dvec3 end = EndOf(this->TheGrid);
    double least = 0.0, most = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      const double first = 0.5 * this->TheGrid.spacing[a], last = end[a] - first;
      const double nearest = this->Periodic[a] ? 0.0 : point[a] - std::clamp(point[a], first, last);
      const double farthest = this->Periodic[a] ? std::numeric_limits<double>::infinity()
                                                : std::max(std::abs(point[a] - first), std::abs(point[a] - last));
      least = std::hypot(least, nearest);
      most = std::hypot(most, farthest);
    }
    return { least, most };
  }

  /// Whether a part contributes so little to the light in the box that one point represents it.
  bool IsFaint(const Area& part) const
  {
    const glm::dvec3 eye = glm::clamp(part.middle, glm::dvec3(0.0), EndOf(this->TheGrid)), way = eye - part.middle;
    const double distance = glm::length(way), cosine = glm::dot(way, this->Normal) / distance;
    if (!(distance > part.Radius()) || !(cosine > 0.0))
    {
      return false;
    }
    const double square = distance * distance, edge = part.Longer();
    const Polygon corners = this->Whole.Corners();
    const double angle = SolidAngle(corners[0] - eye, corners[1] - eye, corners[2] - eye) +
      SolidAngle(corners[0] - eye, corners[2] - eye, corners[3] - eye);
    return part.Size() * cosine / square * (edge * edge / square) < this->LeastError * angle;
  }

  void Divide(const Area& part, const LampPoint::Sphere& whole)
  {
    const bool isAll = whole.radius == std::numeric_limits<double>::infinity();
    const std::array<double, 2> distances = this->Distances(part.middle);
    const bool faint = !isAll && this->IsFaint(part);
    const double from = this->Away * part.Radius();
    const bool far = distances[0] >= from;
    const bool undivided = faint || far || part.Longer() <= this->Finest * (1.0 + 1e-9);
    const LampPoint::Sphere own = { part.middle, undivided ? 0.0 : from };
    if (undivided || distances[1] >= from)
    {
      this->Add(part, own, whole, faint ? 1 : isAll && far ? PointsOfAll : this->PerEdge);
    }
    if (!undivided)
    {
      for (const Area& half : part.Parts())
      {
        this->Divide(half, own);
      }
    }
  }

  void Add(const Area& part, const LampPoint::Sphere& own, const LampPoint::Sphere& whole, int perEdge)
  {
    for (const auto& [point, share] : part.Points(perEdge))
    {
      this->Points.push_back({ PlaceOf(this->TheGrid, point + Vector(this->TheGrid.origin)),
        share * part.Size() / this->Whole.Size(), own, whole, whole.radius + glm::distance(point, whole.middle) });
    }
  }

  const Grid& TheGrid;
  const std::array<bool, 3>& Periodic;
  Area Whole;
  glm::dvec3 Normal;
  double Finest; ///< longer edge of the smallest parts
  double Away;   ///< PartDistance; like PerEdge and LeastError adapted to the light's fineness
  int PerEdge;
  double LeastError;
};

/// Distance between a rectangle and the box, by alternating projection.
double DistanceToBox(const Area& area, const Grid& grid)
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

/// A rectangle on one end of a periodic axis that emits out of the box is moved to the other end, where it emits into
/// the box.
Light ShiningIn(Light light, const Grid& grid, const std::array<bool, 3>& periodic)
{
  if (light.type != LightType::Rectangle)
  {
    return light;
  }
  const Polygon corners = Area(light, grid).Corners();
  const glm::dvec3 normal = Vector(DirectionOf(light));
  for (int a = 0; a < 3; ++a)
  {
    const double end = normal[a] > 0.0 ? grid.Length(a) : 0.0;
    const bool lies = std::all_of(corners.begin(), corners.end(),
      [&](const glm::dvec3& corner) { return std::abs(corner[a] - end) <= OnBorder * grid.Length(a); });
    if (periodic[a] && lies)
    {
      light.position[a] += end > 0.0 ? -grid.Length(a) : grid.Length(a);
    }
  }
  return light;
}
}

LampOnGrid::LampOnGrid(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic)
  : Lamp(ShiningIn(light, grid, periodic))
  , TheGrid(grid)
  , Periodic(periodic)
{
  LampPoint middle;
  middle.place = PlaceOf(grid, Vector(this->Lamp.position));
  this->Centre = { middle };
  this->Points = this->Centre;
  if (light.type == LightType::Point)
  {
    this->Entering = EnteringPart(grid, middle.place, periodic);
  }
  else if (light.type == LightType::Spot)
  {
    this->Entering = EnteringPart(grid, light, middle.place);
  }
  else
  {
    this->DivideRectangle();
  }
}

void LampOnGrid::DivideRectangle()
{
  const Area area(this->Lamp, this->TheGrid);
  const glm::dvec3 end = EndOf(this->TheGrid);
  const double distance = DistanceToBox(area, this->TheGrid), box = std::max({ end.x, end.y, end.z });
  if (distance < Farthest * std::sqrt(area.Longer() * box))
  {
    this->Entering = EnteringPart(this->TheGrid, area, Vector(DirectionOf(this->Lamp)));
  }
  const bool endless = this->Periodic[0] && this->Periodic[1] && this->Periodic[2];
  bool inside = true;
  for (const glm::dvec3& corner : area.Corners())
  {
    const glm::dvec3 aside = glm::abs(corner - 0.5 * end) - (0.5 + OnBorder) * end;
    inside = inside && std::max({ aside.x, aside.y, aside.z }) <= 0.0;
  }
  for (int a = 0; a < 3; ++a)
  {
    this->Images[a] = inside && this->Periodic[a] ? (endless ? ImagesAsideWithoutFaces : ImagesAside) : 0;
  }
  this->Points = RectangleParts(this->TheGrid, this->Periodic, this->Lamp).Points;
}

/// Whether its beams carry all of its light: it is in the box, or its cone lies within the box's solid angle.
bool LampOnGrid::FollowsAll() const
{
  const glm::dvec3 place = this->Centre[0].place;
  bool inside = this->Lamp.type != LightType::Rectangle;
  for (int a = 0; a < 3; ++a)
  {
    const double size = this->TheGrid.size[a];
    inside = inside && (this->Periodic[a] ? place[a] >= 0.0 && place[a] <= size : place[a] > 0.0 && place[a] < size);
  }
  return inside || (this->Lamp.type == LightType::Spot && SeesAllOfCone(this->TheGrid, this->Lamp, place));
}

LampFactors LampOnGrid::Factors(const LampShares& shares, double taken, double even) const
{
  if (this->FollowsAll() && shares.shone > 0.0)
  {
    return { 1.0 / shares.shone, 1.0 / shares.shone, 1.0 / shares.shone };
  }
  const double in = this->Entering > 0.0 && shares.In() > 0.0 ? this->Entering / shares.In() : this->Share();
  if (this->Lamp.type != LightType::Rectangle)
  {
    return { in, in, in };
  }
  // The light of a rectangle's parts does not add up exactly: the power that the medium removes and the power that
  // leaves are corrected, mostly the larger of the two (numerics.md, Eq. (34b)).
  const double share = this->Share(), left = share * (shares.Out() + even), kept = share * taken;
  const double square = kept * kept + left * left;
  if (!(square > 0.0))
  {
    return { 0.0, 0.0, 0.0 }; // the box is dark
  }
  const double rest = (in * shares.In() - kept - left) / square;
  return { in, share * (1.0 + rest * kept), share * (1.0 + rest * left) };
}

/// From the solid angle of the sphere around the box; a power of two.
double LampOnGrid::Share() const
{
  if (this->Lamp.type == LightType::Rectangle && this->Entering > 0.0)
  {
    return std::exp2(std::ceil(std::log2(this->Entering)));
  }
  // solid angle of a sphere over pi (radius / distance)^2, at most, from twice its radius on
  constexpr double ofNearBall = 1.1;
  const Grid& grid = this->TheGrid;
  const double radius = 0.5 * std::hypot(grid.Length(0), grid.Length(1), grid.Length(2));
  glm::dvec3 way = Vector(grid.origin) - Vector(this->Lamp.position);
  for (int a = 0; a < 3; ++a)
  {
    way[a] += 0.5 * grid.Length(a);
  }
  const double ofLamp =
    this->Lamp.type == LightType::Rectangle ? 0.5 * std::hypot(this->Lamp.size[0], this->Lamp.size[1]) : 0.0;
  const double distance = glm::length(way) - ofLamp;
  if (distance < 2.0 * radius)
  {
    return 1.0;
  }
  const double part = radius / distance;
  const double share = ofNearBall * Pi * AxialIntensity(this->Lamp) * part * part;
  return share < 1.0 ? std::exp2(std::ceil(std::log2(share))) : 1.0;
}

std::vector<BeamRow> LampOnGrid::Rows(const Pass& pass, double factor, std::size_t first, std::size_t& next) const
{
  const double ofRectangle = this->Points.size() < ManyPoints ? BeamWidthOfRectangle : BeamWidthOfMany;
  const double width = this->Lamp.type == LightType::Rectangle ? ofRectangle / this->Lamp.fineness : BeamWidth;
  const double margin = 2.0 * this->Diagonal(); // allows for a beam's cross-section and a step
  const std::vector<LampPoint>& points = this->PointsOf(pass);
  std::vector<BeamRow> rows;
  std::size_t beams = 0;
  for (next = first; next < points.size() && beams < BeamsTogether; ++next)
  {
    const LampPoint& point = points[next];
    for (BeamRow& row : Beams(this->TheGrid, this->Periodic, this->Lamp, point.place, width, pass, point.reach))
    {
      row.share = static_cast<float>(point.share * factor);
      for (int a = 0; a < 3; ++a)
      {
        row.part[a] = static_cast<float>(point.part.middle[a] / this->TheGrid.spacing[a]);
        row.whole[a] = static_cast<float>(point.whole.middle[a] / this->TheGrid.spacing[a]);
      }
      const double from = point.part.radius, to = point.whole.radius, seen = std::max(from - margin, 0.0);
      row.partFrom = static_cast<float>(from * from);
      row.partSeen = static_cast<float>(seen * seen);
      row.wholeFrom = static_cast<float>(to * to);
      row.wholeSeen = static_cast<float>((to + margin) * (to + margin));
      beams += row.count;
      rows.push_back(row);
    }
  }
  return rows;
}

int LampOnGrid::SumsOfVacuum() const
{
  return this->Lamp.type != LightType::Rectangle                  ? 0
    : this->Periodic[0] || this->Periodic[1] || this->Periodic[2] ? 2
                                                                  : 1;
}

RectangleInfo LampOnGrid::DescribeRectangle(const VoxelBox& own) const
{
  RectangleInfo info = {};
  const Grid& grid = this->TheGrid;
  const std::array<std::array<double, 3>, 2> edges = RectangleEdges(this->Lamp);
  const glm::dvec3 axes[] = { glm::normalize(Vector(edges[0])), glm::normalize(Vector(edges[1])),
    Vector(DirectionOf(this->Lamp)) };
  const glm::dvec3 first(own.first[0], own.first[1], own.first[2]);
  const glm::dvec3 corner = Vector(grid.origin) + first * Vector(grid.spacing) - Vector(this->Lamp.position);
  for (int a = 0; a < 3; ++a)
  {
    info.corner[a] = static_cast<float>(glm::dot(corner, axes[a]));
    for (int b = 0; b < 3; ++b)
    {
      info.edges[a][b] = static_cast<float>(axes[a][b]);
    }
    info.size[a] = own.size[a];
    info.period[a] = grid.size[a];
    info.images[a] = this->Images[a];
    info.spacing[a] = static_cast<float>(grid.spacing[a]);
  }
  info.reach[0] = static_cast<float>(0.5 * this->Lamp.size[0]);
  info.reach[1] = static_cast<float>(0.5 * this->Lamp.size[1]);
  const double volume = grid.spacing[0] * grid.spacing[1] * grid.spacing[2];
  info.path = static_cast<float>(volume / (Pi * this->Lamp.size[0] * this->Lamp.size[1] * this->Share()));
  info.scale = static_cast<float>(this->UnitsPerLength());
  return info;
}

LampInfo LampOnGrid::Describe(const VoxelBox& stored, const VoxelBox& followed) const
{
  LampInfo info = {};
  const Grid& grid = this->TheGrid;
  const std::array<double, 3> direction = DirectionOf(this->Lamp);
  for (int a = 0; a < 3; ++a)
  {
    info.size[a] = grid.size[a];
    info.first[a] = stored.first[a];
    info.stored[a] = stored.size[a];
    info.followed[a] = followed.first[a];
    info.followedEnd[a] = followed.first[a] + followed.size[a];
    info.periodic[a] = this->Periodic[a];
    info.images[a] = this->Images[a];
    info.spacing[a] = static_cast<float>(grid.spacing[a]);
    info.direction[a] = static_cast<float>(direction[a]);
  }
  info.intensity = static_cast<float>(AxialIntensity(this->Lamp) / this->Share());
  const double sine = std::sin(HalfAngle(this->Lamp));
  info.cosine = static_cast<float>(std::cos(HalfAngle(this->Lamp)));
  info.sineSquare = static_cast<float>(sine * sine);
  info.scale = static_cast<float>(this->UnitsPerLength());
  info.diagonal = static_cast<float>(this->Diagonal());
  for (int face = 0; face < 6; ++face)
  {
    const BoxFaceLayout layout = LayoutOfFace(grid, face);
    info.faceFirst[face] = static_cast<cl_int>(layout.first);
    std::copy(layout.step.begin(), layout.step.end(), info.faceStep[face / 2]);
  }
  return info;
}

/// No voxel can gather more than the full power along its diagonal, once per round.
double LampOnGrid::UnitsPerLength() const
{
  return std::exp2(std::floor(std::log2(0x1p60 / (this->Diagonal() * RoundsAtMost))));
}

double LampOnGrid::Diagonal() const
{
  const std::array<double, 3>& h = this->TheGrid.spacing;
  return std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
}

cl::Kernel LampOnGrid::Kernel(Device& device, const char* name, std::string_view source, const Deposit& deposit) const
{
  return device.Kernel(name, source,
    Define("ATOMICS", HasAtomics(device)) + Define("LAMBERT", this->Lamp.type == LightType::Rectangle) +
      Define("CONE", this->Lamp.type == LightType::Spot) + Define("MOMENTS", deposit.firstMoments != nullptr) +
      Define("NET_FLUX", deposit.flux != nullptr) + Define("FACE_OUT", deposit.faceOut != nullptr) +
      Define("VACUUM", this->SumsOfVacuum() > 0) + Define("AROUND", this->SumsOfVacuum() > 1) +
      " -DTHIN=" + FloatLiteral(ThinForFirstMoments));
}
}
