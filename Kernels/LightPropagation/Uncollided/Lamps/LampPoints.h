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
/// A point source that represents a lamp, or a part of a rectangle.
struct LampPoint
{
  struct Sphere ///< centre, from the grid's corner, and radius, lengths
  {
    glm::dvec3 middle = glm::dvec3(0.0);
    double radius = 0.0;
  };

  glm::dvec3 place;   ///< position, voxels from the grid's corner
  double share = 1.0; ///< fraction of the lamp's power

  /// The point illuminates voxels outside the sphere `part` and inside the sphere `whole`. Voxels beyond `whole` are
  /// illuminated by points of a larger part of the rectangle, of which this point's part is a subdivision.
  Sphere part, whole = { glm::dvec3(0.0), std::numeric_limits<double>::infinity() };
  /// Length to which beams from this point are traced; infinite: until they leave the box
  double reach = std::numeric_limits<double>::infinity();
};

/// Distance from a face, as a fraction of the box's edge, below which a lamp is taken to be on the face.
constexpr double OnBorder = 1e-6;

/// Position of a point in space, voxels from the grid's corner; snapped to a face that is nearer than OnBorder.
glm::dvec3 PlaceOf(const Grid& grid, const glm::dvec3& point);

/// Corner of the box opposite to the grid's corner, lengths from the grid's corner.
inline glm::dvec3 EndOf(const Grid& grid)
{
  return { grid.Length(0), grid.Length(1), grid.Length(2) };
}

using Polygon = std::vector<glm::dvec3>; ///< corners of a planar, convex polygon, lengths

/// A rectangular lamp, or a part of one. Lengths are from the grid's corner.
struct RectangleArea
{
  glm::dvec3 middle;
  std::array<glm::dvec3, 2> half; ///< half of each of the two edges, as a vector

  RectangleArea(const Light& light, const Grid& grid);

  double Longer() const; ///< length of the longer edge
  double Radius() const; ///< radius of the circumscribed circle
  double Size() const;   ///< area of the rectangle
  glm::dvec3 At(double a, double b) const { return this->middle + a * this->half[0] + b * this->half[1]; }
  Polygon Corners() const { return { this->At(-1, -1), this->At(1, -1), this->At(1, 1), this->At(-1, 1) }; }

  /// Halves of the rectangle, divided across the longer edge; or quarters if the edges are similar, so that rotated
  /// scenes are divided equally.
  std::vector<RectangleArea> Parts() const;
  /// Gauss points and their weights. A square has `perEdge` points along each edge; an elongated rectangle has about as
  /// many in total, with more along the longer edge and fewer along the shorter one.
  std::vector<std::pair<glm::dvec3, double>> Points(int perEdge) const;
};

/// Points that represent a rectangular lamp. The rectangle is divided into parts, so that each voxel is lit by parts
/// that are small compared with their distance from it, and that together make up the whole rectangle.
std::vector<LampPoint> PointsOfRectangle(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic);
}
