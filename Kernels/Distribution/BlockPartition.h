#pragma once

#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Partition of a grid into blocks, one per rank; blocks may be empty.
struct BlockPartition
{
  Grid whole;
  std::vector<VoxelBox> blocks; ///< block of each rank, by rank, in voxels of the whole grid

  /// Checks the partition.
  /// @throws InvalidInput if a block reaches beyond the grid, two blocks overlap, or a voxel is in no block
  void Check() const;

  /// Grid of a rank's block; without voxels if the block is empty.
  Grid OwnGrid(int rank) const;

  /// Creates a partition by recursive bisection of the grid across its longest edge, as evenly as integer numbers of
  /// voxels allow. If there are fewer voxels than ranks, the last blocks are empty.
  static BlockPartition Even(const Grid& whole, int ranks);
};

/// Index along an axis of the first voxel beyond the upper end of a box.
inline int EndOf(const VoxelBox& box, int axis)
{
  return box.first[axis] + box.size[axis];
}

/// Calls act(place, voxel) for each row along x of the box `part` within the box `box`; `voxel` is the row's first
/// voxel, `place` its index in an array over `box`.
template <class Act>
void ForRows(const VoxelBox& part, const VoxelBox& box, const Act& act)
{
  for (int z = part.first[2]; z < EndOf(part, 2); ++z)
  {
    for (int y = part.first[1]; y < EndOf(part, 1); ++y)
    {
      const std::size_t row = static_cast<std::size_t>(z - box.first[2]) * box.size[1] + (y - box.first[1]);
      act(row * box.size[0] + (part.first[0] - box.first[0]), std::array<int, 3>{ part.first[0], y, z });
    }
  }
}

/// Whether a box contains a voxel of the grid.
/// @param voxel  three indices
bool Holds(const VoxelBox& box, const int* voxel);

/// The box grown by `by` voxels on each side, clipped to the grid.
VoxelBox Grown(const VoxelBox& box, int by, const Grid& whole);

/// The ranks whose blocks touch a rank's block at a face, an edge or a corner.
/// @param reach  distance, voxels; blocks closer than this count as well
/// @param periodic  periodic axes, whose two ends touch
std::vector<int> NeighboursOf(
  const BlockPartition& partition, int rank, int reach = 1, const std::array<bool, 3>& periodic = {});

/// The intersection of two boxes; if it is empty, its size is 0 along some axis.
VoxelBox Common(const VoxelBox& a, const VoxelBox& b);
}
