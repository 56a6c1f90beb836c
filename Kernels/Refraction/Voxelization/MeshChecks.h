#pragma once

#include "Medium/Grid.h"
#include "Refraction/Voxelization/TriangleMesh.h"
#include "Refraction/Voxelization/Voxelization.h"

#include <string>
#include <vector>

namespace tyndall
{
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
