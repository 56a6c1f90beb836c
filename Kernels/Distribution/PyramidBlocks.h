#pragma once

#include "Distribution/Domain.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// A pyramid over a distributed grid. Each rank computes the levels up to `shared` for its block and a margin around
/// it, and contributes its cells of the shared level; every rank that has voxels computes the levels above, which are
/// small. On one rank the box is the whole grid.
class PyramidBlocks
{
public:
  /// @param domain  must outlive this
  /// @param shared  index of the shared level
  /// @param margin  width of the margin, voxels
  /// @param edge  voxels, a multiple of the edge of a shared cell; boxes begin and, except at the grid's end, end at
  ///   multiples of it
  PyramidBlocks(const Domain& domain, int shared, int margin, int edge);

  int Shared() const { return this->SharedLevel; }
  /// The voxels that this rank works on: its block and its margin.
  const VoxelBox& Box() const { return this->Boxes[static_cast<std::size_t>(this->TheDomain.Rank())]; }
  /// A grid over the same box with `size` voxels or cells.
  Grid GridOf(const std::array<int, 3>& size) const;
  /// The cells of the shared level whose first voxel lies in this rank's box.
  VoxelBox BoxCells() const { return this->CellsIn(this->Box()); }
  /// All cells of the shared level.
  VoxelBox AllCells() const { return { {}, this->Cells.whole.size }; }

  /// Values of the voxels of this rank's box, from the ranks that own them. Collective.
  /// @param own      `components` for each voxel of this rank's block, x fastest
  /// @param storage  holds the result, unless every rank's box is its block: then that is `own`
  const float* Gather(const float* own, int components, std::vector<float>& storage) const;

  /// Values of all cells of the shared level, from those of each rank's BoxCells. Collective.
  /// @param made  `components` per cell of this rank's BoxCells, x fastest
  /// @return empty on a rank without voxels
  std::vector<float> GatherCells(const std::vector<float>& made, int components) const;

  /// Reduces an array over this rank's box to its block.
  void Crop(std::vector<float>& values, int components) const;
  void Crop(std::vector<std::uint8_t>& values) const;

private:
  VoxelBox CellsIn(const VoxelBox& box) const;

  const Domain& TheDomain;
  int SharedLevel;
  std::vector<VoxelBox> Boxes; ///< by rank
  bool AnyMargin = false;      ///< whether some rank's box is larger than its block
  BlockPartition Cells;        ///< cells of the shared level, by the rank that contributes them
};
}
