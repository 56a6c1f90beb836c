#pragma once

#include "Distribution/Domain.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// A pyramid over a domain. Each rank makes the levels up to `shared` for its block and a margin around it, and
/// contributes its cells of the shared level; the levels above, a small part of the grid, are made on every rank that
/// has voxels. On one rank the box is the whole grid.
class PyramidBlocks
{
public:
  /// @param domain  must outlive this
  /// @param shared  level
  /// @param margin  voxels
  /// @param edge    voxels, a multiple of those of a shared cell: boxes begin at multiples of it and, except at the
  ///   grid's end, end there
  PyramidBlocks(const Domain& domain, int shared, int margin, int edge);

  int Shared() const { return this->SharedLevel; }
  /// The voxels that this rank works on: its block and the margin.
  const VoxelBox& Box() const { return this->Boxes[static_cast<std::size_t>(this->TheDomain.Rank())]; }
  /// The whole grid, but with this many voxels or cells.
  Grid GridOf(const std::array<int, 3>& size) const;
  /// The cells of the shared level whose first voxels are in this rank's box.
  VoxelBox BoxCells() const { return this->CellsIn(this->Box()); }
  /// All cells of the shared level.
  VoxelBox AllCells() const { return { {}, this->Cells.whole.size }; }

  /// Values of the voxels of this rank's box, from the ranks that own them. Collective.
  /// @param own      `components` for each voxel of this rank's block, x fastest
  /// @param storage  holds the result, unless every rank's box is its block: then that is `own`
  const float* Gather(const float* own, int components, std::vector<float>& storage) const;

  /// Values of all cells of the shared level, from those of each rank's BoxCells. Collective.
  /// @param made  `components` for each, x fastest
  /// @return empty on a rank without voxels
  std::vector<float> GatherCells(const std::vector<float>& made, int components) const;

  /// Leaves the values of this rank's block of those of its box.
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
