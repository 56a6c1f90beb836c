#pragma once

#include "Medium/Field.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Transfer of values between a grid and a coarser grid over the same box: averaging and refinement. May be restricted
/// to boxes of both grids (PartOf).
class Coarsening
{
public:
  /// Transfer to a coarse grid with half as many voxels per axis, rounded down, at least one.
  explicit Coarsening(const Grid& fine);
  /// Transfer to a given coarse grid.
  /// @param coarse  grid over the same box as `fine`, along no axis finer
  Coarsening(const Grid& fine, const Grid& coarse);

  /// This transfer restricted to a box of each grid. Average() requires that `fine` contains FineBox(coarse); it then
  /// returns bit for bit the values of the unrestricted transfer. Parent() requires that `coarse` contains
  /// ParentBox(fine).
  Coarsening PartOf(const VoxelBox& fine, const VoxelBox& coarse) const;
  /// Box of the fine voxels that overlap a box of coarse voxels.
  VoxelBox FineBox(const VoxelBox& coarse) const;
  /// Box of the coarse voxels whose centres lie in a box of fine voxels. If boxes partition the fine grid, their coarse
  /// boxes partition the coarse grid.
  VoxelBox CoarseBox(const VoxelBox& fine) const;
  /// Box of the coarse voxels that contain the centres of a box of fine voxels.
  VoxelBox ParentBox(const VoxelBox& fine) const;

  const Grid& Fine() const { return this->FineGrid; }
  const Grid& Coarse() const { return this->CoarseGrid; }
  /// Smallest ratio of coarse to fine spacing among the axes with more than one voxel; 1 if there is none.
  double Ratio() const;

  /// Means over coarse voxels. Each fine voxel is weighted by its overlap, so that the integral is conserved. A mean is
  /// NaN if any of its fine values is NaN.
  /// @param values  values of the fine voxels, x fastest, `components` each
  std::vector<float> Average(const float* values, int components) const;

  /// Weighted means over coarse voxels; 0 if all weights are 0. Used for the mean cosine, with sigma_s as weight
  /// (numerics.md, Eq. (3e)). Means are clamped to the range of the values, so that rounding cannot exceed it.
  /// @param weights  weights of the fine voxels, not negative
  /// @return 3 components per coarse voxel if values or weights are coloured, else 1
  std::vector<float> Average(const Field& values, const Field& weights) const;

  /// Interpolates coarse values at the centres of the fine voxels: linearly between coarse centres, constant beyond the
  /// outermost ones. A restricted transfer requires that its coarse box contains ParentBox(fine) and one layer of
  /// coarse voxels around it, clipped to the grid.
  /// @param values  values of the coarse voxels, x fastest, `components` each
  std::vector<float> Refine(const std::vector<float>& values, int components) const;

  /// Index of the coarse voxel that contains the centre of a fine voxel.
  std::size_t Parent(std::size_t fineVoxel) const;

private:
  struct Between;
  std::vector<Between> BetweenAlong(int axis) const;
  void MixRows(const std::vector<float>& values, const Between& y, const Between& z, std::vector<float>& row) const;

  Grid FineGrid, CoarseGrid;
  VoxelBox FinePart, CoarsePart;             ///< boxes of the fine and of the coarse grid that the transfer covers
  std::array<int, 3> FineOfAll, CoarseOfAll; ///< sizes of the complete grids, voxels
};
}
