#pragma once

#include "Medium/Field.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Transfer between a grid and a coarser grid over the same box: averaging and refinement. May cover a part of both
/// grids.
class Coarsening
{
public:
  /// Half as many voxels per axis, rounded down, at least one.
  explicit Coarsening(const Grid& fine);
  /// @param coarse  grid over the same box, nowhere finer
  Coarsening(const Grid& fine, const Grid& coarse);

  /// The same transfer restricted to a box of each grid. Average needs all of FineBox(coarse), and returns bit for bit
  /// what it returns for the whole grids; Parent needs all of ParentBox(fine).
  Coarsening PartOf(const VoxelBox& fine, const VoxelBox& coarse) const;
  /// Fine voxels that overlap a box of coarse voxels.
  VoxelBox FineBox(const VoxelBox& coarse) const;
  /// Coarse voxels whose centres lie in a box of fine voxels. Boxes that partition the fine grid yield boxes that
  /// partition the coarse grid.
  VoxelBox CoarseBox(const VoxelBox& fine) const;
  /// Coarse voxels that contain the centres of a box of fine voxels.
  VoxelBox ParentBox(const VoxelBox& fine) const;

  const Grid& Fine() const { return this->FineGrid; }
  const Grid& Coarse() const { return this->CoarseGrid; }
  /// Smallest ratio of coarse to fine spacing among the axes with more than one voxel; 1 if there is none.
  double Ratio() const;

  /// Means over coarse voxels: each fine voxel is weighted by its overlap, so that the integral is conserved. NaN if
  /// one of the fine values is.
  /// @param values  `components` per fine voxel, x fastest
  std::vector<float> Average(const float* values, int components) const;

  /// Weighted means over coarse voxels, 0 where all weights are 0. Used for the mean cosine, weighted by sigma_s
  /// (numerics.md, Eq. (3e)). Means are clamped to the range of the values, so that rounding cannot exceed it.
  /// @param weights  not negative
  /// @return 3 components per coarse voxel if values or weights are coloured, else 1
  std::vector<float> Average(const Field& values, const Field& weights) const;

  /// Interpolates coarse values at the centres of the fine voxels: linearly between coarse centres, constant beyond
  /// them. A part needs all of ParentBox(fine) and one layer of coarse voxels around it, clipped to the grid.
  /// @param values  `components` per coarse voxel, x fastest
  std::vector<float> Refine(const std::vector<float>& values, int components) const;

  /// The coarse voxel that contains the centre of a fine voxel.
  std::size_t Parent(std::size_t fineVoxel) const;

private:
  struct Between;
  std::vector<Between> BetweenAlong(int axis) const;
  void MixRows(const std::vector<float>& values, const Between& y, const Between& z, std::vector<float>& row) const;

  Grid FineGrid, CoarseGrid;
  VoxelBox FinePart, CoarsePart;             ///< in voxels of the whole grids
  std::array<int, 3> FineOfAll, CoarseOfAll; ///< sizes of the whole grids, voxels
};
}
