#include "LightPropagation/Uncollided/Lamps/LampPoints.h"

#include "Numerics/Vectors.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tyndall
{
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

RectangleArea::RectangleArea(const Light& light, const Grid& grid)
  : middle(Vector(light.position) - Vector(grid.origin))
{
  const std::array<std::array<double, 3>, 2> edges = RectangleEdges(light);
  this->half = { 0.5 * Vector(edges[0]), 0.5 * Vector(edges[1]) };
}

double RectangleArea::Longer() const
{
  return 2.0 * std::max(glm::length(this->half[0]), glm::length(this->half[1]));
}

double RectangleArea::Radius() const
{
  return std::hypot(glm::length(this->half[0]), glm::length(this->half[1]));
}

double RectangleArea::Size() const
{
  return 4.0 * glm::length(this->half[0]) * glm::length(this->half[1]);
}

std::vector<RectangleArea> RectangleArea::Parts() const
{
  constexpr double muchLonger = 1.5;
  const double lengths[] = { glm::length(this->half[0]), glm::length(this->half[1]) };
  const bool first = lengths[0] * muchLonger > lengths[1], second = lengths[1] * muchLonger > lengths[0];
  std::vector<RectangleArea> parts;
  for (int i = 0; i < (first ? 2 : 1) * (second ? 2 : 1); ++i)
  {
    RectangleArea part = *this;
    part.half[0] *= first ? 0.5 : 1.0;
    part.half[1] *= second ? 0.5 : 1.0;
    const bool upper[] = { i % 2 == 1, first ? i / 2 == 1 : i % 2 == 1 };
    part.middle += (first ? (upper[0] ? 1.0 : -1.0) : 0.0) * part.half[0];
    part.middle += (second ? (upper[1] ? 1.0 : -1.0) : 0.0) * part.half[1];
    parts.push_back(part);
  }
  return parts;
}

std::vector<std::pair<glm::dvec3, double>> RectangleArea::Points(int perEdge) const
{
  constexpr int most = 4;
  constexpr double places[][most] = { { 0.0 }, { -0.577350269189626, 0.577350269189626 },
    { -0.774596669241483, 0.0, 0.774596669241483 },
    { -0.861136311594053, -0.339981043584856, 0.339981043584856, 0.861136311594053 } };
  constexpr double shares[][most] = { { 1.0 }, { 0.5, 0.5 }, { 5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0 },
    { 0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727 } };
  const double longer = std::sqrt(glm::length(this->half[0]) / glm::length(this->half[1]));
  // The 1e-9 makes the number of points independent of rounding, and so the same in scenes that differ by a rotation
  const auto along = [=](double stretch) {
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

namespace
{
/// A part of a rectangle lights voxels whose distance from its centre is at least this many of its radii; for nearer
/// voxels the part is divided.
constexpr double PartDistance = 2.0;
/// Number of Gauss points along each edge of a square: for a part of a rectangle, and for a rectangle that is not
/// divided
constexpr int PointsOfPart = 2, PointsOfAll = 3;
constexpr double FinestPart = 2.0;   ///< longer edge of the smallest parts, voxels
constexpr double PartsAcross = 64.0; ///< maximum number of smallest parts along the box's longest edge
constexpr double Faint = 0.1;        ///< relative error of the light below which one point represents a part

/// Solid angle of a triangle, sr (van Oosterom and Strackee).
double SolidAngle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
  const double x = glm::length(a), y = glm::length(b), z = glm::length(c);
  return 2.0 *
    std::atan2(std::abs(glm::dot(a, glm::cross(b, c))),
      x * y * z + glm::dot(a, b) * z + glm::dot(b, c) * x + glm::dot(c, a) * y);
}

/// Division of a rectangle into parts: each voxel is lit by parts that are small compared with their distance from it,
/// and that together make up the whole rectangle.
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
  /// Smallest and largest distance of the box's voxels from a point, lengths.
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

  /// Whether a part of the rectangle contributes so little to the light in the box that one point suffices to represent
  /// it.
  bool IsFaint(const RectangleArea& part) const
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

  void Divide(const RectangleArea& part, const LampPoint::Sphere& whole)
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
      for (const RectangleArea& half : part.Parts())
      {
        this->Divide(half, own);
      }
    }
  }

  void Add(const RectangleArea& part, const LampPoint::Sphere& own, const LampPoint::Sphere& whole, int perEdge)
  {
    for (const auto& [point, share] : part.Points(perEdge))
    {
      this->Points.push_back({ PlaceOf(this->TheGrid, point + Vector(this->TheGrid.origin)),
        share * part.Size() / this->Whole.Size(), own, whole, whole.radius + glm::distance(point, whole.middle) });
    }
  }

  const Grid& TheGrid;
  const std::array<bool, 3>& Periodic;
  RectangleArea Whole;
  glm::dvec3 Normal;
  double Finest; ///< length of the longer edge of the smallest parts
  /// A part lights voxels at this or a larger distance from its centre, in radii of the part. The value is
  /// PartDistance, or more if Light::fineness is large.
  double Away;
  int PerEdge;
  double LeastError;
};
}

std::vector<LampPoint> PointsOfRectangle(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic)
{
  return RectangleParts(grid, periodic, light).Points;
}
}
