#pragma once

#include "Medium/Grid.h"
#include "Refraction/Voxelization/TriangleMesh.h"
#include "Refraction/Voxelization/WindingNumbers.h"

#include <string>
#include <vector>

namespace tyndall
{
/// @param name     of the mesh, for the message
/// @param samples  fine voxels per edge of a voxel, see SampleLattice: a mesh that is closed there passes
/// @return what was found
/// @throws InvalidInput where the mesh is empty, has no area, or is open: names the count of boundary edges, and the
/// first
MeshTopology CheckClosed(const TriangleMesh& mesh, const std::string& name, const Grid& grid, int samples);

/// How the corners of a closed mesh's triangles run, see OrientedMesh.
int Orientation(const MeshTopology& topology);

/// What is odd about a closed mesh, a sentence each: triangles without area, edges that disagree about what is outside,
/// normals that point inwards, and samples about which it winds neither 0 times nor once, as where it intersects
/// itself.
std::vector<std::string> Oddities(
  const MeshTopology& topology, const WindingNumbers& windings, const std::string& name, const Grid& grid, int samples);
}
