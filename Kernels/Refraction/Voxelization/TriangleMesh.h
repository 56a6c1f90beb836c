#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tyndall
{
struct Grid;
struct WindingNumbers;

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

/// @param name     name of the mesh, for the message
/// @param samples  fine voxels per edge of a voxel, see SampleLattice: a mesh that is closed on that lattice passes
/// @return the properties of the mesh's surface
/// @throws InvalidInput if the mesh is empty, has no area, or is open; names the count of boundary edges, and the first
MeshTopology CheckClosed(const TriangleMesh& mesh, const std::string& name, const Grid& grid, int samples);

/// Orientation of a closed mesh's triangles, see OrientedMesh::orientation.
int Orientation(const MeshTopology& topology);

/// Irregularities of a closed mesh, a sentence each: triangles without area, edges that disagree about what is outside,
/// normals that point inwards, and samples whose winding number is neither 0 nor 1, as where the mesh intersects
/// itself.
std::vector<std::string> Oddities(
  const MeshTopology& topology, const WindingNumbers& windings, const std::string& name, const Grid& grid, int samples);
}
