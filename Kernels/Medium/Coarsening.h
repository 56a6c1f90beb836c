#pragma once

#include "Medium/Field.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <vector>

namespace tyndall
{
/// A coarser grid over the same box, and averages over its voxels; or a part of both grids.
class Coarsening
{
public:
  /// Half as many voxels per axis, rounded down, at least one.
  explicit Coarsening(const Grid& fine);
  /// @param coarse  the same box, nowhere finer
  Coarsening(const Grid& fine, const Grid& coarse);

  /// The same of a box of each grid alone. Average needs all of FineBox(coarse), and gives what it gives of the whole,
  /// bit for bit; Parent needs all of ParentBox(fine).
  Coarsening PartOf(const VoxelBox& fine, const VoxelBox& coarse) const;
  /// Fine voxels of which a part lies in a box of coarse voxels.
  VoxelBox FineBox(const VoxelBox& coarse) const;
  /// Of coarse voxels those whose centres lie in a box of fine ones. Boxes that fill the fine grid have each of them
  /// once.
  VoxelBox CoarseBox(const VoxelBox& fine) const;
  /// Coarse voxels in which centres of a box of fine voxels lie.
  VoxelBox ParentBox(const VoxelBox& fine) const;

  const Grid& Fine() const { return this->FineGrid; }
  const Grid& Coarse() const { return this->CoarseGrid; }
  /// Smallest ratio of coarse to fine spacing among the axes that have several voxels; 1 where none has.
  double Ratio() const;

  /// Means over coarse voxels: every fine voxel counts by the part of it that lies inside, so that the sum is kept. NaN
  /// where one of them is.
  /// @param values  `components` a fine voxel, x fastest
  std::vector<float> Average(const float* values, int components) const;

  /// Means weighted by another quantity, 0 where that is 0 throughout. So a coarse voxel gets its mean cosine, weighted
  /// by sigma_s (numerics.md, Eq. (3e)). Rounding leaves no mean beyond the largest and the smallest value.
  /// @param weights  not negative
  /// @return 3 components a coarse voxel where either has colour, else 1
  std::vector<float> Average(const Field& values, const Field& weights) const;

  /// Of values of the coarse voxels those at the fine ones' middles: linear between the coarse ones' middles, and
  /// constant beyond them. A part needs all of ParentBox(fine), and a layer of voxels round it as far as the grid goes.
  /// @param values  `components` a coarse voxel, x fastest
  std::vector<float> Refine(const std::vector<float>& values, int components) const;

  /// The coarse voxel in which the centre of a fine one lies.
  std::size_t Parent(std::size_t fineVoxel) const;

private:
  struct Between;
  std::vector<Between> BetweenAlong(int axis) const;
  void MixRows(const std::vector<float>& values, const Between& y, const Between& z, std::vector<float>& row) const;

  Grid FineGrid, CoarseGrid;
  VoxelBox FinePart, CoarsePart;             ///< in the grids of the whole
  std::array<int, 3> FineOfAll, CoarseOfAll; ///< voxels of these along each axis
};
}
