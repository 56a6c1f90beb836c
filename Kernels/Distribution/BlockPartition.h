#pragma once

#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <vector>

namespace tyndall
{
/// A grid that is cut into boxes, one a rank, some of which may be empty.
struct BlockPartition
{
  Grid whole;
  std::vector<VoxelBox> blocks; ///< by rank, in voxels of the whole grid

  /// @throws InvalidInput where a block reaches beyond the grid, two have a voxel in common, or a voxel is in none
  void Check() const;

  /// The grid of a rank's own voxels; of an empty block one of no voxels.
  Grid OwnGrid(int rank) const;

  /// The same grid cut again and again across its longest edge, as evenly as voxels allow; into fewer blocks where
  /// there are fewer voxels than ranks, and the last ones are empty.
  static BlockPartition Even(const Grid& whole, int ranks);
};

/// Past the last voxel of a box along an axis.
inline int EndOf(const VoxelBox& box, int axis)
{
  return box.first[axis] + box.size[axis];
}

/// Whether a voxel, three numbers, is in a box.
bool Holds(const VoxelBox& box, const int* voxel);

/// A box and so many voxels round it, as far as the grid goes.
VoxelBox Grown(const VoxelBox& box, int by, const Grid& whole);

/// The ranks whose blocks touch that of one, at a face, an edge or a corner.
/// @param reach  voxels: those too that are fewer than so many apart from it
/// @param periodic  axes whose two ends touch
std::vector<int> NeighboursOf(
  const BlockPartition& partition, int rank, int reach = 1, const std::array<bool, 3>& periodic = {});

/// The voxels that two boxes share; without any its size is 0 along some axis.
VoxelBox Common(const VoxelBox& a, const VoxelBox& b);
}
