#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Triangles by the numbers of their corners, which run counterclockwise where seen from outside.
struct TriangleMesh
{
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<int, 3>> triangles;

  /// Of each point in the mesh that it was taken from, for messages; empty: their own.
  std::vector<std::size_t> pointNumbers;
};

/// @throws InvalidInput where a point is not finite: names the first
void CheckPoints(const TriangleMesh& mesh);

/// What can be wrong with the surface of a solid.
///
/// Points at the same place count as one, so that a box whose faces have corners of their own is closed all the same.
struct MeshTopology
{
  using Edge = std::array<std::array<double, 3>, 2>; ///< its ends

  std::size_t boundaryEdges = 0; ///< edges of an odd number of triangles: where there are any, the mesh has no inside
  Edge firstBoundaryEdge = {};   ///< of those, the one whose corners have the lowest numbers
  std::size_t disagreeingEdges = 0; ///< edges on two sides of which different sides of the mesh are the outer one
  Edge firstDisagreeingEdge = {};
  std::size_t degenerateTriangles = 0; ///< triangles without area
  std::size_t firstDegenerateTriangle = 0;
  /// Length^3, negative where the corners run clockwise; has no meaning where edges disagree.
  double enclosedVolume = 0.0;
};

/// @throws InvalidInput where the mesh has no triangle, a triangle a corner that is not there, or a point is not finite
MeshTopology Examine(const TriangleMesh& mesh);
}
