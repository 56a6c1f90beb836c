#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/VoxelBox.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// Copies the values of a part of a box, `components` per voxel, x fastest.
std::vector<float> PartOf(const std::vector<float>& values, const VoxelBox& box, const VoxelBox& part, int components);
std::vector<std::int64_t> PartOf(const std::vector<std::int64_t>& values, const VoxelBox& box, const VoxelBox& part);
std::vector<std::uint8_t> PartOf(const std::vector<std::uint8_t>& values, const VoxelBox& box, const VoxelBox& part);

/// Writes the values of a part back into those of the box.
void PutPart(const std::vector<float>& taken, std::vector<float>& values, const VoxelBox& box, const VoxelBox& part,
  int components);

/// Gathers the values of the box that each rank wants, which may reach into other ranks' blocks. Collective.
/// @param wanted  the box that each rank wants, within the grid; may be empty
/// @param own  `components` per voxel of this rank's block, x fastest
/// @return `components` per voxel of the box that this rank wants
std::vector<float> ValuesInBox(Communicator& communicator, const BlockPartition& partition,
  const std::vector<VoxelBox>& wanted, const std::vector<float>& own, int components);
}
