#include "Photons/Emission/PhotonPlane.h"

#include "Numerics/Constants.h"
#include "Photons/Emission/SampleSequence.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
double Cross(const glm::dvec2& a, const glm::dvec2& b)
{
  return a.x * b.y - a.y * b.x;
}

/// Lower (`side` 1) or upper (`side` -1) chain of the convex hull of sorted points (Andrew's monotone chain).
std::vector<glm::dvec2> Chain(const std::vector<glm::dvec2>& sorted, double side)
{
  std::vector<glm::dvec2> chain;
  for (const glm::dvec2& point : sorted)
  {
    while (
      chain.size() > 1 && side * Cross(chain.back() - chain[chain.size() - 2], point - chain[chain.size() - 2]) <= 0.0)
    {
      chain.pop_back();
    }
    chain.push_back(point);
  }
  return chain;
}

bool IsBefore(const glm::dvec2& a, const glm::dvec2& b)
{
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

/// Sorts points by x, and makes nearly equal x exactly equal. Rounding separates the corners of a box seen face-on; the
/// hull would then treat the sliver between them as an edge.
std::vector<glm::dvec2> Sorted(std::vector<glm::dvec2> points)
{
  std::sort(points.begin(), points.end(), IsBefore);
  const double sliver = 1e-12 * (points.back().x - points.front().x);
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    if (points[i].x - points[i - 1].x <= sliver)
    {
      points[i].x = points[i - 1].x;
    }
  }
  std::sort(points.begin(), points.end(), IsBefore);
  return points;
}

double HeightAt(const std::vector<glm::dvec2>& chain, double x, bool fromLeft)
{
  for (std::size_t i = 1; i < chain.size(); ++i)
  {
    const glm::dvec2& a = chain[i - 1];
    const glm::dvec2& b = chain[i];
    if (b.x > a.x && (fromLeft ? x >= a.x && x < b.x : x > a.x && x <= b.x))
    {
      return a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
    }
  }
  return chain.back().y;
}

/// Index of the step of a cumulative table in which the fraction u of the total is reached. `part` receives the
/// position of that fraction within the step.
std::size_t Choose(const std::vector<double>& cumulative, double u, double& part)
{
  return static_cast<std::size_t>(FindStep(cumulative.data(), static_cast<int>(cumulative.size()) - 1, u, part));
}

glm::dvec3 Corner(const Grid& grid, int which)
{
  glm::dvec3 corner;
  for (int a = 0; a < 3; ++a)
  {
    corner[a] = grid.origin[a] + (which >> a & 1) * grid.size[a] * grid.spacing[a];
  }
  return corner;
}

/// Unit vector perpendicular to the direction, along the projection of an axis of the volume. A face seen face-on is
/// thus mapped to a square grid.
glm::dvec3 AxisAcross(const glm::dvec3& direction)
{
  const glm::dvec3 axis = std::abs(direction.x) < 0.9 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  return glm::normalize(axis - direction * glm::dot(direction, axis));
}

std::vector<glm::dvec2> Project(const Grid& grid, const glm::dvec3& across, const glm::dvec3& along)
{
  std::vector<glm::dvec2> points;
  for (int i = 0; i < 8; ++i)
  {
    points.emplace_back(glm::dot(across, Corner(grid, i)), glm::dot(along, Corner(grid, i)));
  }
  return points;
}
}

ConvexPolygon::ConvexPolygon(std::vector<glm::dvec2> points)
{
  points = Sorted(std::move(points));
  const std::vector<glm::dvec2> low = Chain(points, 1.0);
  const std::vector<glm::dvec2> high = Chain(points, -1.0);
  std::vector<double> xs;
  for (const glm::dvec2& point : points)
  {
    if (xs.empty() || point.x > xs.back())
    {
      xs.push_back(point.x);
    }
  }
  for (std::size_t i = 1; i < xs.size(); ++i)
  {
    const Slice slice = { xs[i - 1], xs[i], HeightAt(low, xs[i - 1], true), HeightAt(low, xs[i], false),
      HeightAt(high, xs[i - 1], true), HeightAt(high, xs[i], false) };
    const double area = 0.5 * (slice.x1 - slice.x0) * ((slice.high0 - slice.low0) + (slice.high1 - slice.low1));
    this->Slices.push_back(slice);
    this->Below.push_back(this->Below.back() + area);
  }
}

glm::dvec2 ConvexPolygon::At(double u, double v) const
{
  double part;
  const Slice& slice = this->Slices[Choose(this->Below, u, part)];
  const double w0 = slice.high0 - slice.low0;
  const double w1 = slice.high1 - slice.low1;
  // t is the fraction of the slice's width that encloses the fraction `part` of its area, for heights w0 and w1 at the
  // slice's ends. It solves w0 t + (w1 - w0) t^2 / 2 = part (w0 + w1) / 2, here without cancellation.
  const double wanted = part * (w0 + w1);
  const double root = std::sqrt(std::max(w0 * w0 + (w1 - w0) * wanted, 0.0));
  const double t = w0 + root > 0.0 ? std::min(wanted / (w0 + root), 1.0) : part;
  const double low = slice.low0 + t * (slice.low1 - slice.low0);
  const double high = slice.high0 + t * (slice.high1 - slice.high0);
  return { slice.x0 + t * (slice.x1 - slice.x0), low + v * (high - low) };
}

PhotonPlane::PhotonPlane(const Grid& grid, const glm::dvec3& direction)
  : Across(AxisAcross(direction))
  , Along(glm::cross(direction, this->Across))
  , Origin(0.0)
  , Outline(Project(grid, this->Across, this->Along))
{
  double first = glm::dot(direction, Corner(grid, 0));
  for (int i = 1; i < 8; ++i)
  {
    first = std::min(first, glm::dot(direction, Corner(grid, i)));
  }
  this->Origin = direction * first;
}

glm::dvec3 PhotonPlane::At(double u, double v) const
{
  const glm::dvec2 point = this->Outline.At(u, v);
  return this->Origin + this->Across * point.x + this->Along * point.y;
}

SphericalRectangle::SphericalRectangle(const glm::dvec3& eye, const glm::dvec3& corner, const glm::dvec3& firstEdge,
  const glm::dvec3& secondEdge, double smallBelow)
  : Eye(eye)
  , X(glm::normalize(firstEdge))
  , Y(glm::normalize(secondEdge))
  , Z(glm::cross(this->X, this->Y))
{
  const glm::dvec3 d = corner - eye;
  this->Z = glm::dot(d, this->Z) > 0.0 ? -this->Z : this->Z;
  this->X0 = glm::dot(d, this->X);
  this->Y0 = glm::dot(d, this->Y);
  this->Z0 = glm::dot(d, this->Z);
  this->X1 = this->X0 + glm::length(firstEdge);
  this->Y1 = this->Y0 + glm::length(secondEdge);

  const glm::dvec3 v00(this->X0, this->Y0, this->Z0), v01(this->X0, this->Y1, this->Z0);
  const glm::dvec3 v10(this->X1, this->Y0, this->Z0), v11(this->X1, this->Y1, this->Z0);
  const glm::dvec3 n0 = glm::normalize(glm::cross(v00, v10)), n1 = glm::normalize(glm::cross(v10, v11));
  const glm::dvec3 n2 = glm::normalize(glm::cross(v11, v01)), n3 = glm::normalize(glm::cross(v01, v00));
  const auto angle = [](const glm::dvec3& a, const glm::dvec3& b) {
    return std::acos(std::min(std::max(-glm::dot(a, b), -1.0), 1.0));
  };
  const double g0 = angle(n0, n1), g1 = angle(n1, n2), g2 = angle(n2, n3), g3 = angle(n3, n0);
  this->B0 = n0.z;
  this->B1 = n2.z;
  this->K = 2.0 * Pi - g2 - g3;
  this->Angle = g0 + g1 - this->K;
  if (this->Angle < smallBelow) // small angles have rounding errors, as differences of large angles
  {
    const glm::dvec3 middle(0.5 * (this->X0 + this->X1), 0.5 * (this->Y0 + this->Y1), this->Z0);
    const double distance = glm::length(middle);
    this->Small = true;
    this->Angle = this->AngleByArea(distance);
  }
}

glm::dvec3 SphericalRectangle::At(double u, double v) const
{
  double x = this->X0 + u * (this->X1 - this->X0);
  double y = this->Y0 + v * (this->Y1 - this->Y0);
  if (!this->Small)
  {
    const double au = u * this->Angle + this->K;
    const double fu = (std::cos(au) * this->B0 - this->B1) / std::sin(au);
    double cu = std::copysign(1.0 / std::sqrt(fu * fu + this->B0 * this->B0), fu);
    cu = std::min(std::max(cu, -1.0), 1.0);
    x = -(cu * this->Z0) / std::max(std::sqrt(1.0 - cu * cu), 1e-15);
    x = std::min(std::max(x, this->X0), this->X1);
    const double d = std::hypot(x, this->Z0);
    const double h0 = this->Y0 / std::hypot(d, this->Y0);
    const double h1 = this->Y1 / std::hypot(d, this->Y1);
    const double h = h0 + v * (h1 - h0);
    y = h * h < 1.0 - 1e-12 ? h * d / std::sqrt(1.0 - h * h) : h > 0.0 ? this->Y1 : this->Y0;
  }
  return this->Eye + this->X * x + this->Y * y + this->Z * this->Z0;
}

double SphericalRectangle::SolidAngleBy(const glm::dvec3& point) const
{
  return this->Small ? this->AngleByArea(glm::length(point - this->Eye)) : this->Angle;
}

double SphericalRectangle::AngleByArea(double distance) const
{
  return (this->X1 - this->X0) * (this->Y1 - this->Y0) * -this->Z0 / (distance * distance * distance);
}

VisibleFaces::VisibleFaces(const Grid& grid, const glm::dvec3& eye)
{
  const glm::dvec3 low = Corner(grid, 0), high = Corner(grid, 7);
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2;
    const bool up = face % 2 == 1;
    if (up ? eye[axis] <= high[axis] : eye[axis] >= low[axis])
    {
      continue;
    }
    glm::dvec3 corner = low, first(0.0), second(0.0);
    corner[axis] = up ? high[axis] : low[axis];
    first[(axis + 1) % 3] = high[(axis + 1) % 3] - low[(axis + 1) % 3];
    second[(axis + 2) % 3] = high[(axis + 2) % 3] - low[(axis + 2) % 3];
    this->Faces.emplace_back(eye, corner, first, second);
    this->Below.push_back(this->SolidAngle() + this->Faces.back().SolidAngle());
  }
}

glm::dvec3 VisibleFaces::At(double u, double v) const
{
  double part;
  const std::size_t face = Choose(this->Below, u, part);
  return this->Faces[face].At(part, v);
}

LampView::LampView(const Grid& grid, const glm::dvec3& lamp)
  : Place(lamp)
{
  const glm::dvec3 low = Corner(grid, 0), high = Corner(grid, 7);
  bool outside = false;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double slack = Slack * (high[axis] - low[axis]);
    const bool atLow = std::abs(lamp[axis] - low[axis]) <= slack;
    const bool atHigh = std::abs(lamp[axis] - high[axis]) <= slack;
    outside = outside || lamp[axis] < low[axis] - slack || lamp[axis] > high[axis] + slack;
    this->Inwards[axis] = atLow ? 1 : atHigh ? -1 : 0;
    this->Place[axis] = atLow ? low[axis] : atHigh ? high[axis] : lamp[axis];
  }
  if (outside)
  {
    this->Inwards = { 0, 0, 0 };
    this->Faces.emplace(grid, this->Place);
  }
}

double LampView::SolidAngle() const
{
  const auto faces = std::count_if(this->Inwards.begin(), this->Inwards.end(), [](int side) { return side != 0; });
  return this->Faces ? this->Faces->SolidAngle() : std::ldexp(4.0 * Pi, -static_cast<int>(faces));
}

glm::dvec3 LampView::Direction(double u, double v) const
{
  if (this->Faces)
  {
    return glm::normalize(this->Faces->At(u, v) - this->Place);
  }
  // Axes of spherical coordinates for the lamp. The polar axis is the normal of a face on which the lamp lies, the
  // azimuth starts at the normal of a second such face. Coordinate axes take the place of missing faces.
  std::array<int, 3> axes = { 2, 0, 1 };
  std::stable_partition(axes.begin(), axes.end(), [this](int axis) { return this->Inwards[axis] != 0; });
  const auto& [pole, first, second] = axes;
  const auto side = [this](int axis) { return this->Inwards[axis] < 0 ? -1.0 : 1.0; };
  const double cosine = this->Inwards[pole] != 0 ? 1.0 - u : 1.0 - 2.0 * u;
  const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
  const double turn = this->Inwards[second] != 0 ? 0.5 * Pi * v
    : this->Inwards[first] != 0                  ? Pi * (v - 0.5)
                                                 : 2.0 * Pi * v;
  glm::dvec3 direction;
  direction[pole] = side(pole) * cosine;
  direction[first] = side(first) * sine * std::cos(turn);
  direction[second] = side(second) * sine * std::sin(turn);
  return direction;
}

bool LampView::Enters(const glm::dvec3& direction) const
{
  return direction.x * this->Inwards[0] >= 0.0 && direction.y * this->Inwards[1] >= 0.0 &&
    direction.z * this->Inwards[2] >= 0.0;
}
}
