#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tyndall
{
struct Grid;
struct WindingNumbers;

/// A mesh of triangles. A triangle has the indices of its corners, counterclockwise as seen from outside.
struct TriangleMesh
{
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<int, 3>> triangles;

  /// Index of each point in the user's mesh, for messages. Empty: the indices in `points` are the user's.
  std::vector<std::size_t> pointNumbers;
};

/// Checks the points of a mesh.
/// @throws InvalidInput if a point is not finite; names the first such point
void CheckPoints(const TriangleMesh& mesh);

/// Properties and defects of the surface of a solid.
///
/// Coincident points count as one, so that a box whose faces do not share their corners still counts as closed.
struct MeshTopology
{
  using Edge = std::array<std::array<double, 3>, 2>; ///< positions of the ends of an edge

  /// Number of edges with an odd number of triangles; if it is not 0, the mesh has no inside.
  std::size_t boundaryEdges = 0;
  Edge firstBoundaryEdge = {}; ///< the boundary edge whose ends have the lowest point indices
  /// Number of edges whose two triangles disagree about which side of the mesh is outside.
  std::size_t disagreeingEdges = 0;
  Edge firstDisagreeingEdge = {};          ///< the disagreeing edge whose ends have the lowest point indices
  std::size_t degenerateTriangles = 0;     ///< number of triangles without area
  std::size_t firstDegenerateTriangle = 0; ///< index of the first triangle without area
  /// Enclosed volume, in units of length^3. It is negative if the corners of triangles run clockwise as seen from
  /// outside, and has no meaning if disagreeingEdges is above 0.
  double enclosedVolume = 0.0;
};

/// Examines the surface of a mesh.
/// @throws InvalidInput if the mesh has no triangle, a triangle has an invalid corner index, or a point is not finite
MeshTopology Examine(const TriangleMesh& mesh);

/// Checks that a mesh is closed, if necessary after rounding to the lattice of its voxelisation.
/// @param name     name of the mesh, for the message
/// @param samples  number of fine voxels per edge of a voxel, see SampleLattice
/// @return properties of the mesh's surface
/// @throws InvalidInput if the mesh is empty, has no area, or is open; names the number of boundary edges, and the
///   first
MeshTopology CheckClosed(const TriangleMesh& mesh, const std::string& name, const Grid& grid, int samples);

/// Orientation of a closed mesh's triangles as seen from outside: 1 counterclockwise, -1 clockwise, 0 if triangles
/// disagree.
int Orientation(const MeshTopology& topology);

/// Describes the irregularities of a closed mesh, one sentence each. These are triangles without area, triangles that
/// disagree about the outside, normals that point inwards, and samples with a winding number other than 0 or 1 (for
/// example where the mesh intersects itself).
std::vector<std::string> Oddities(
  const MeshTopology& topology, const WindingNumbers& windings, const std::string& name, const Grid& grid, int samples);
}
