#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Who makes what of a pyramid over a grid that is spread over ranks by blocks: each rank the levels below `shared`, of
/// its block and a margin of voxels round it, and its cells of the shared level; levels from that on, a small part of
/// the grid, each has of all.
struct PyramidBlocks
{
  /// @param level   the shared one
  /// @param margin  voxels
  /// @param edge    voxels, a multiple of those of a shared cell: at multiples of it boxes begin and, but at the grid's
  ///   end, end
  PyramidBlocks(const BlockPartition& partition, int level, int margin, int edge);

  /// The cells of the shared level whose first voxels are in a box.
  VoxelBox CellsIn(const VoxelBox& box) const;
  /// This rank's block and margin.
  const VoxelBox& Around(int rank) const { return this->around[static_cast<std::size_t>(rank)]; }
  /// The grid, but with so many voxels or cells.
  Grid GridOf(const std::array<int, 3>& size) const;
  const std::array<int, 3>& SharedSize() const { return this->cells.whole.size; }

  /// Values of all cells of the shared level, from those that each rank has made of its box. All ranks call it.
  /// @param made  `fields` for each cell in this rank's box, x fastest
  /// @return the same of all, empty where the rank has no voxels
  std::vector<float> Gather(Communicator& communicator, const std::vector<float>& made, int fields) const;

  const BlockPartition& partition;
  int shared;
  std::vector<VoxelBox> around; ///< by rank, the voxels that it works on
  BlockPartition cells;         ///< of the shared level, those that ranks make known
};
}
