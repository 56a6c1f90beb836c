#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/VoxelBox.h"

#include <cstdint>
#include <vector>

namespace tyndall
{
/// Extracts the values in the box `part` from an array over the box `box`, `components` per voxel (default 1), x
/// fastest.
std::vector<float> PartOf(const std::vector<float>& values, const VoxelBox& box, const VoxelBox& part, int components);
std::vector<std::int64_t> PartOf(const std::vector<std::int64_t>& values, const VoxelBox& box, const VoxelBox& part);
std::vector<std::uint8_t> PartOf(const std::vector<std::uint8_t>& values, const VoxelBox& box, const VoxelBox& part);

/// Writes the values `taken` of the box `part` to an array over the box `box`, `components` per voxel, x fastest.
void PutPart(const std::vector<float>& taken, std::vector<float>& values, const VoxelBox& box, const VoxelBox& part,
  int components);

/// Gathers, on each rank, the values in a box that may reach into other ranks' blocks. Collective.
/// @param wanted  by rank, the box whose values the rank needs, within the grid; may be empty
/// @param own  values of this rank's block, `components` per voxel, x fastest
/// @return values of this rank's box `wanted`, `components` per voxel, x fastest
std::vector<float> ValuesInBox(Communicator& communicator, const BlockPartition& partition,
  const std::vector<VoxelBox>& wanted, const std::vector<float>& own, int components);
/// Gathers the values of the whole grid on every rank. Collective; parameters as for ValuesInBox.
std::vector<float> ValuesOfGrid(
  Communicator& communicator, const BlockPartition& partition, const std::vector<float>& own, int components);
}
