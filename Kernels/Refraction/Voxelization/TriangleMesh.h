#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Triangles as indices of their corners, counterclockwise as seen from outside.
struct TriangleMesh
{
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<int, 3>> triangles;

  /// Index of each point in the mesh that it was taken from, for messages; empty: the points' own indices.
  std::vector<std::size_t> pointNumbers;
};

/// @throws InvalidInput if a point is not finite; names the first
void CheckPoints(const TriangleMesh& mesh);

/// Defects of the surface of a solid.
///
/// Coincident points count as one, so that a box whose faces have corners of their own still counts as closed.
struct MeshTopology
{
  using Edge = std::array<std::array<double, 3>, 2>; ///< the ends of the edge

  /// Edges with an odd number of triangles: if there are any, the mesh has no inside.
  std::size_t boundaryEdges = 0;
  Edge firstBoundaryEdge = {}; ///< the boundary edge whose corners have the lowest indices
  /// Edges whose two triangles disagree about which side of the mesh is outside.
  std::size_t disagreeingEdges = 0;
  Edge firstDisagreeingEdge = {};
  std::size_t degenerateTriangles = 0; ///< triangles without area
  std::size_t firstDegenerateTriangle = 0;
  /// Length^3, negative if the corners run clockwise; meaningless if edges disagree.
  double enclosedVolume = 0.0;
};

/// @throws InvalidInput if the mesh has no triangle, a triangle has an invalid corner index, or a point is not finite
MeshTopology Examine(const TriangleMesh& mesh);
}
