#pragma once

#include "Refraction/Octree/RefractionOctree.h"

#include <array>
#include <vector>

namespace tyndall
{
/// @throws InvalidInput where a setting is out of its range
void Check(const OctreeSettings& settings);

/// @param grid   of the index
/// @param whole, first  the grid of which it is a part, and the voxel with which it begins: voxels are named by that
/// @throws InvalidInput where the index is not there, or not finite and above 0 in a voxel: names the first
void CheckIndex(const Field& index, const Grid& grid, const Grid& whole, const std::array<int, 3>& first);

/// Largest differences of the index, and of sigma_t, in the nodes of each level: as floats, for which <= says the same.
std::vector<float> IndexTolerances(int levelCount, double tolerance);
std::vector<float> ExtinctionTolerances(const Grid& grid, int levelCount, double tolerance);

/// How many channels of extinction restrict nodes: 0 where it is not included.
int ExtinctionChannels(const Medium& medium, const OctreeSettings& settings);

/// Of sigma_t = sigma_a + sigma_s.
std::vector<float> Extinction(const Medium& medium, int channel);
}
