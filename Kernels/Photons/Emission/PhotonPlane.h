#pragma once

#include "Medium/Grid.h"

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace tyndall
{
/// A convex polygon with a continuous, area-preserving map from the unit square: uniform samples stay uniform.
class ConvexPolygon
{
public:
  /// The convex hull of the points.
  explicit ConvexPolygon(std::vector<glm::dvec2> points);

  double Area() const { return this->Below.back(); }
  glm::dvec2 At(double u, double v) const;

private:
  /// Between two consecutive corners in x: lower and upper bounds at its left (0) and right (1) edges.
  struct Slice
  {
    double x0, x1, low0, low1, high0, high1;
  };
  std::vector<Slice> Slices;
  std::vector<double> Below = { 0.0 }; ///< cumulative area up to the end of each slice
};

/// The photon plane of parallel light: perpendicular to its direction, bounded by the outline of the volume.
class PhotonPlane
{
public:
  PhotonPlane(const Grid& grid, const glm::dvec3& direction);

  double Area() const { return this->Outline.Area(); }
  glm::dvec3 At(double u, double v) const; ///< a point on the plane, upstream of the volume

private:
  glm::dvec3 Across, Along, Origin;
  ConvexPolygon Outline;
};

/// A rectangle seen from a point, with a map from the unit square that preserves solid angle. Urena, Fajardo, King: An
/// Area-Preserving Parametrization for Spherical Rectangles, EGSR 2013.
class SphericalRectangle
{
public:
  /// @param corner                one corner of the rectangle
  /// @param firstEdge,secondEdge  edge vectors from that corner, at right angles
  /// @param smallBelow            solid angle below which the map preserves area instead
  SphericalRectangle(const glm::dvec3& eye, const glm::dvec3& corner, const glm::dvec3& firstEdge,
    const glm::dvec3& secondEdge, double smallBelow = 1e-6);

  double SolidAngle() const { return this->Angle; }
  glm::dvec3 At(double u, double v) const; ///< a point on the rectangle

  /// Weight of a point returned by At, sr; its mean over the unit square is the solid angle. Constant unless the map
  /// preserves area.
  double SolidAngleBy(const glm::dvec3& point) const;

private:
  /// Solid angle of the whole rectangle, computed from its area as if all of it were at this distance.
  double AngleByArea(double distance) const;

  glm::dvec3 Eye, X, Y, Z; ///< axes of the rectangle, Z towards the eye
  double X0, X1, Y0, Y1, Z0;
  double B0, B1, K;
  double Angle = 0.0;
  bool Small = false; ///< so distant that the solid angle per area is constant, or seen nearly edge-on
};

/// The faces of the volume visible from a point outside: up to three.
class VisibleFaces
{
public:
  VisibleFaces(const Grid& grid, const glm::dvec3& eye);

  double SolidAngle() const { return this->Below.back(); }
  glm::dvec3 At(double u, double v) const; ///< a point on these faces, uniform in solid angle

private:
  std::vector<SphericalRectangle> Faces;
  std::vector<double> Below = { 0.0 }; ///< cumulative solid angle up to the end of each face
};

/// The directions from a lamp into the volume: the whole sphere inside it, half of that on a face, a quarter on an
/// edge, an eighth at a corner; from outside, the solid angle of the visible faces. A lamp counts as on a face within
/// the rounding of its position, a millionth of the volume's edge.
class LampView
{
public:
  static constexpr double Slack = 1e-6;

  LampView(const Grid& grid, const glm::dvec3& lamp);

  const glm::dvec3& Lamp() const { return this->Place; } ///< position, moved onto the face that the lamp is on
  bool Outside() const { return this->Faces.has_value(); }
  double SolidAngle() const;
  glm::dvec3 Direction(double u, double v) const; ///< into the volume, unit length, uniform in solid angle

  /// Whether a direction does not point outwards through a face that the lamp is on.
  bool Enters(const glm::dvec3& direction) const;

private:
  glm::dvec3 Place;
  /// Inward direction, -1 or 1, along axes where the lamp is on a face, else 0.
  std::array<int, 3> Inwards = { 0, 0, 0 };
  std::optional<VisibleFaces> Faces;
};
}
