#pragma once

#include "Medium/Grid.h"

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace tyndall
{
/// A convex polygon, onto which the unit square is mapped continuously and keeping areas in proportion: what is spread
/// evenly stays so.
class ConvexPolygon
{
public:
  /// The convex hull of the points.
  explicit ConvexPolygon(std::vector<glm::dvec2> points);

  double Area() const { return this->Below.empty() ? 0.0 : this->Below.back(); }
  glm::dvec2 At(double u, double v) const;

private:
  struct Slice ///< between two corners: from its left to its right edge
  {
    double x0, x1, low0, low1, high0, high1;
  };
  std::vector<Slice> Slices;
  std::vector<double> Below; ///< area up to the end of each slice
};

/// The plane across a direction that photons of parallel light set out from: the outline of the volume, no more.
class PhotonPlane
{
public:
  PhotonPlane(const Grid& grid, const glm::dvec3& direction);

  double Area() const { return this->Outline.Area(); }
  glm::dvec3 At(double u, double v) const; ///< a point of it, before the volume

private:
  glm::dvec3 Across, Along, Origin;
  ConvexPolygon Outline;
};

/// A rectangle as it is seen from a point; the unit square is mapped onto it so that solid angles keep in proportion.
/// Urena, Fajardo, King: An Area-Preserving Parametrization for Spherical Rectangles, EGSR 2013.
class SphericalRectangle
{
public:
  /// @param corner                of the rectangle
  /// @param firstEdge,secondEdge  from the corner, at a right angle
  /// @param smallBelow            solid angle below which the square is mapped onto it in proportion to area
  SphericalRectangle(const glm::dvec3& eye, const glm::dvec3& corner, const glm::dvec3& firstEdge,
    const glm::dvec3& secondEdge, double smallBelow = 1e-6);

  double SolidAngle() const { return this->Angle; }
  glm::dvec3 At(double u, double v) const; ///< a point on the rectangle

  /// Weight of a point of At, sr: its mean over the unit square is the solid angle. It is the same for all points where
  /// the square is not mapped by area.
  double SolidAngleBy(const glm::dvec3& point) const;

private:
  double AngleByArea(double distance) const; ///< of all of it, as if it were as far away as one of its points

  glm::dvec3 Eye, X, Y, Z; ///< axes of the rectangle, Z towards the eye
  double X0, X1, Y0, Y1, Z0;
  double B0, B1, K;
  double Angle = 0.0;
  bool Small = false; ///< so far away that all of it is seen under the same angle, or nearly from the side
};

/// What is seen of the volume from a point outside of it: up to three of its faces.
class VisibleFaces
{
public:
  VisibleFaces(const Grid& grid, const glm::dvec3& eye);

  double SolidAngle() const { return this->Below.empty() ? 0.0 : this->Below.back(); }
  glm::dvec3 At(double u, double v) const; ///< a point on them, by solid angle

private:
  std::vector<SphericalRectangle> Faces;
  std::vector<double> Below; ///< solid angle up to each
};

/// What a lamp sees of the volume: all around it inside, half of that on a face, a quarter on an edge, an eighth at a
/// corner, the faces from outside. A lamp counts as on a face that it is off by no more than rounding of its position
/// may cause, a millionth of the volume's edge.
class LampView
{
public:
  static constexpr double Slack = 1e-6;

  LampView(const Grid& grid, const glm::dvec3& lamp);

  const glm::dvec3& Lamp() const { return this->Place; } ///< where it is; put onto the face that it is on
  bool Outside() const { return this->Faces.has_value(); }
  double SolidAngle() const;
  glm::dvec3 Direction(double u, double v) const; ///< into the volume, unit length, by solid angle

  /// Whether a direction does not lead away from a face that the lamp is on.
  bool Enters(const glm::dvec3& direction) const;

private:
  glm::dvec3 Place;
  std::array<int, 3> Inwards = { 0, 0, 0 }; ///< -1 or 1 along an axis where it is on a face, else 0
  std::optional<VisibleFaces> Faces;
};
}
