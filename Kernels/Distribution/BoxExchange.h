#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/VoxelBox.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// Of values of a box those of a part of it, `components` a voxel, x fastest.
std::vector<float> PartOf(const std::vector<float>& values, const VoxelBox& box, const VoxelBox& part, int components);
std::vector<std::int64_t> PartOf(const std::vector<std::int64_t>& values, const VoxelBox& box, const VoxelBox& part);
std::vector<std::uint8_t> PartOf(const std::vector<std::uint8_t>& values, const VoxelBox& box, const VoxelBox& part);

/// The other way round.
void PutPart(const std::vector<float>& taken, std::vector<float>& values, const VoxelBox& box, const VoxelBox& part,
  int components);

/// Numbers from each rank to each, this one as well; ranks without voxels neither send nor get any. All ranks that have
/// voxels call it.
/// @param toEach, return  by rank
std::vector<std::vector<std::size_t>> NumbersOfEach(
  Communicator& communicator, const BlockPartition& partition, const std::vector<std::vector<std::size_t>>& toEach);

/// Values of the voxels of a box that each rank wants, which may reach into the blocks of others. All ranks call it.
/// @param wanted  by rank, within the grid; of no voxels where a rank wants none
/// @param own  `components` for each voxel of this rank's block, x fastest
/// @return the same for each voxel of the box that this rank wants
std::vector<float> ValuesInBox(Communicator& communicator, const BlockPartition& partition,
  const std::vector<VoxelBox>& wanted, const std::vector<float>& own, int components);

/// The other way round: what each rank has found for the voxels of a box, which may reach into the blocks of others,
/// summed up for each rank's block, in whole numbers, so that the order of ranks does not matter. All ranks call it.
/// @param found  by rank, the boxes, within the grid; of no voxels where a rank has found nothing
/// @param values  one for each voxel of this rank's box, x fastest
/// @return one for each voxel of this rank's block
std::vector<std::int64_t> SumsInBlock(Communicator& communicator, const BlockPartition& partition,
  const std::vector<VoxelBox>& found, const std::vector<std::int64_t>& values);
}
