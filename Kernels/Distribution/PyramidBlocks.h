#pragma once

#include "Distribution/Domain.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// Levels of a pyramid over a distributed grid: the grid itself, and successively coarser grids whose cells each
/// combine several cells of the level below. Each rank computes the levels up to the level `shared` in its box, which
/// is its block and a margin around it. The cells of the shared level are then exchanged, and every rank that has
/// voxels computes the levels above, which are small. On one rank the box is the whole grid.
class PyramidBlocks
{
public:
  /// Determines the boxes of all ranks and their cells of the shared level.
  /// @param domain  must outlive this object
  /// @param shared  index of the shared level, the highest one that ranks compute for their own boxes
  /// @param margin  width of the margin, voxels
  /// @param edge  number of voxels, a multiple of the edge of a cell of the shared level. Boxes begin at multiples of
  ///   it, and end at multiples of it or at the grid's end
  PyramidBlocks(const Domain& domain, int shared, int margin, int edge);

  int Shared() const { return this->SharedLevel; }
  /// The voxels for which this rank computes the levels up to the shared one: its block and its margin.
  const VoxelBox& Box() const { return this->Boxes[static_cast<std::size_t>(this->TheDomain.Rank())]; }
  /// Grid of `size` voxels along each axis, with origin and spacing of the domain's grid.
  Grid GridOf(const std::array<int, 3>& size) const;
  /// The cells of the shared level that this rank computes: those whose first voxel lies in its box.
  VoxelBox BoxCells() const { return this->CellsIn(this->Box()); }
  /// All cells of the shared level in the whole domain.
  VoxelBox AllCells() const { return { {}, this->Cells.whole.size }; }

  /// Values of the voxels of this rank's box, gathered from the ranks that own them. Collective.
  /// @param own      values of this rank's block, `components` per voxel, x fastest
  /// @param storage  receives the values, unless every rank's box is its block
  /// @return pointer to the values: in `storage`, or `own`
  const float* Gather(const float* own, int components, std::vector<float>& storage) const;

  /// Values of all cells of the shared level, gathered from the ranks that compute them (BoxCells). Collective.
  /// @param made  values of this rank's BoxCells, `components` per cell, x fastest
  /// @return `components` per cell, x fastest; empty on a rank without voxels
  std::vector<float> GatherCells(const std::vector<float>& made, int components) const;

  /// Crops an array over this rank's box to its block.
  void Crop(std::vector<float>& values, int components) const;
  void Crop(std::vector<std::uint8_t>& values) const;

private:
  VoxelBox CellsIn(const VoxelBox& box) const;

  const Domain& TheDomain;
  int SharedLevel;
  std::vector<VoxelBox> Boxes; ///< by rank: its box, which is its block and a margin around it
  bool AnyMargin = false;      ///< whether some rank's box is larger than its block
  /// Cells of the shared level, the highest one that ranks compute for their boxes, partitioned among the ranks.
  BlockPartition Cells;
};
}
