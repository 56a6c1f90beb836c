#pragma once

#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"
#include "Viewing/Scene/ViewShared.h"

#include <vector>

namespace tyndall
{
/// Points and parallel beams that stand for the lights.
std::vector<SmallLight> SmallLights(const std::vector<Light>& lights, const Grid& grid, int rectangleSamples);

/// Whether ways from the centres of these voxels to a light may lead through a block: the box of all of them meets it.
/// @param grid  the whole, of which both are parts
/// @param from, block  false where one of them has no voxels
bool MayLeadThrough(const SmallLight& light, const Grid& grid, const VoxelBox& from, const VoxelBox& block);
}
