#pragma once

#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"
#include "Viewing/Scene/ViewShared.h"

#include <vector>

namespace tyndall
{
/// Replaces the lights by point lights and parallel beams.
std::vector<SmallLight> SmallLights(const std::vector<Light>& lights, const Grid& grid, int rectangleSamples);

/// Whether shadow rays from the centres of the voxels `from` to a light can cross a block: tests whether the box around
/// all of these rays meets the block.
/// @param grid  the whole domain, to which the indices of both boxes refer
/// @param from, block  boxes of voxels; the result is false if one is empty
bool MayLeadThrough(const SmallLight& light, const Grid& grid, const VoxelBox& from, const VoxelBox& block);
}
