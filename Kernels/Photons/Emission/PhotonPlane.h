#pragma once

#include "Medium/Grid.h"

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace tyndall
{
/// A convex polygon with a continuous, area-preserving map from the unit square: uniform samples of the square are
/// uniform on the polygon.
class ConvexPolygon
{
public:
  /// Builds the convex hull of the points.
  explicit ConvexPolygon(std::vector<glm::dvec2> points);

  double Area() const { return this->Below.back(); }
  glm::dvec2 At(double u, double v) const;

private:
  /// Trapezoid of the polygon between two consecutive corners in x, from x0 to x1. Its lower (low) and upper (high)
  /// bounds in y are given at x0 (suffix 0) and x1 (suffix 1).
  struct Slice
  {
    double x0, x1, low0, low1, high0, high1;
  };
  std::vector<Slice> Slices;
  std::vector<double> Below = { 0.0 }; ///< cumulative area up to the end of each slice, with a leading 0
};

/// The photon plane of parallel light: the plane perpendicular to the light's direction, bounded by the outline of
/// the volume.
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

/// A rectangle seen from a point (the eye), with a map from the unit square that preserves solid angle. Urena,
/// Fajardo, King: An Area-Preserving Parametrization for Spherical Rectangles, EGSR 2013.
class SphericalRectangle
{
public:
  /// Prepares the map for a rectangle seen from `eye`.
  /// @param corner                one corner of the rectangle
  /// @param firstEdge,secondEdge  edge vectors from that corner, at right angles
  /// @param smallBelow            solid angle, sr, below which the map preserves area instead
  SphericalRectangle(const glm::dvec3& eye, const glm::dvec3& corner, const glm::dvec3& firstEdge,
    const glm::dvec3& secondEdge, double smallBelow = 1e-6);

  double SolidAngle() const { return this->Angle; }
  glm::dvec3 At(double u, double v) const; ///< a point on the rectangle

  /// Weight, sr, of a point returned by At; the mean weight over the unit square is the solid angle of the rectangle.
  /// All weights are equal unless the map preserves area.
  double SolidAngleBy(const glm::dvec3& point) const;

private:
  /// Solid angle, sr, that the rectangle would have if all of its area were at the given distance from the eye.
  double AngleByArea(double distance) const;

  glm::dvec3 Eye, X, Y, Z; ///< position of the eye; axes of the rectangle, Z towards the eye
  double X0, X1, Y0, Y1, Z0;
  double B0, B1, K;
  double Angle = 0.0;
  /// Whether the map preserves area instead of solid angle: the rectangle is distant, or seen nearly edge-on
  bool Small = false;
};

/// Faces of the volume that are visible from a point outside it: up to three.
class VisibleFaces
{
public:
  VisibleFaces(const Grid& grid, const glm::dvec3& eye);

  double SolidAngle() const { return this->Below.back(); }
  glm::dvec3 At(double u, double v) const; ///< a point on the visible faces, uniform in solid angle

private:
  std::vector<SphericalRectangle> Faces;
  std::vector<double> Below = { 0.0 }; ///< cumulative solid angle, sr, up to the end of each face, with a leading 0
};

/// The directions from a lamp into the volume. Inside the volume they are the full sphere; on a face half, on an edge a
/// quarter, at a corner an eighth of the sphere. For a lamp outside they are the solid angle of the visible faces. A
/// lamp counts as on a face if its distance from the face is at most a millionth of the volume's edge, which allows for
/// rounding.
class LampView
{
public:
  static constexpr double Slack = 1e-6;

  LampView(const Grid& grid, const glm::dvec3& lamp);

  /// Position of the lamp, moved exactly onto a face if the lamp counts as on the face.
  const glm::dvec3& Lamp() const { return this->Place; }
  bool Outside() const { return this->Faces.has_value(); }
  double SolidAngle() const;
  glm::dvec3 Direction(double u, double v) const; ///< a direction into the volume, unit length, uniform in solid angle

  /// Whether a direction leads into the volume: false if the lamp lies on a face and the direction points out through
  /// it.
  bool Enters(const glm::dvec3& direction) const;

private:
  glm::dvec3 Place;
  /// Inward direction, -1 or 1, along each axis across which the lamp is on a face; 0 along other axes.
  std::array<int, 3> Inwards = { 0, 0, 0 };
  std::optional<VisibleFaces> Faces;
};
}
