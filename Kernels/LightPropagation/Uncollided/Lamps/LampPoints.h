#pragma once

#include "Lights/Lights.h"
#include "Medium/Grid.h"

#include <glm/vec3.hpp>

#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace tyndall
{
/// A point source that represents a lamp, or a part of it.
struct LampPoint
{
  struct Sphere ///< in lengths from the grid's corner
  {
    glm::dvec3 middle = glm::dvec3(0.0);
    double radius = 0.0;
  };

  glm::dvec3 place;   ///< position, voxels from the grid's corner
  double share = 1.0; ///< fraction of the lamp's power

  /// The point illuminates voxels outside the first sphere and inside the second, beyond which the larger part of the
  /// lamp that was divided into this one takes over.
  Sphere part, whole = { glm::dvec3(0.0), std::numeric_limits<double>::infinity() };
  double reach = std::numeric_limits<double>::infinity(); ///< length to which its beams are traced
};

/// Fraction of the box's edges: a lamp this near to a face counts as on it, as for photons.
constexpr double OnBorder = 1e-6;

/// A point in space as a position in voxels from the grid's corner; snapped to a face if next to it.
glm::dvec3 PlaceOf(const Grid& grid, const glm::dvec3& point);

/// The corner of the box opposite to the grid's corner, relative to it, lengths.
inline glm::dvec3 EndOf(const Grid& grid)
{
  return { grid.Length(0), grid.Length(1), grid.Length(2) };
}

using Polygon = std::vector<glm::dvec3>; ///< planar and convex

/// A rectangular lamp, or a part of one. Lengths from the grid's corner.
struct RectangleArea
{
  glm::dvec3 middle;
  std::array<glm::dvec3, 2> half; ///< half edge vectors

  RectangleArea(const Light& light, const Grid& grid);

  double Longer() const; ///< longer edge
  double Radius() const; ///< of the circumscribed circle
  double Size() const;   ///< area
  glm::dvec3 At(double a, double b) const { return this->middle + a * this->half[0] + b * this->half[1]; }
  Polygon Corners() const { return { this->At(-1, -1), this->At(1, -1), this->At(1, 1), this->At(-1, 1) }; }

  /// Its halves, across the longer edge; quarters if the edges are similar, so that rotated scenes are divided alike.
  std::vector<RectangleArea> Parts() const;
  /// Gauss points and their weights, `perEdge` along each edge of a square; for an elongated rectangle about as many in
  /// total, more along it and fewer across.
  std::vector<std::pair<glm::dvec3, double>> Points(int perEdge) const;
};

/// The points that represent a rectangular lamp. It is divided into parts, so that each voxel is lit by parts that are
/// small compared with their distance from it, and that together make up the whole rectangle.
std::vector<LampPoint> PointsOfRectangle(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic);
}
