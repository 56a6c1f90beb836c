#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/VoxelBox.h"

#include <vector>

namespace tyndall
{
/// Of values of a box those of a part of it, `components` a voxel, x fastest.
std::vector<float> PartOf(const std::vector<float>& values, const VoxelBox& box, const VoxelBox& part, int components);

/// Values of the voxels of a box that each rank wants, which may reach into the blocks of others. All ranks call it.
/// @param wanted  by rank, within the grid; of no voxels where a rank wants none
/// @param own  `components` for each voxel of this rank's block, x fastest
/// @return the same for each voxel of the box that this rank wants
std::vector<float> ValuesInBox(Communicator& communicator, const BlockPartition& partition,
  const std::vector<VoxelBox>& wanted, const std::vector<float>& own, int components);
}
