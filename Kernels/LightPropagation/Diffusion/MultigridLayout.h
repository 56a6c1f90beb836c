#pragma once

#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Multigrid levels of a whole grid, the finest first. Each coarser level joins pairs of voxels along the axes whose
/// voxel edges are below 1.9 times the shortest edge, until at most 64 voxels are left.
/// @param spacing  voxel edges of the finest level
std::vector<MultigridLevel> MultigridLevels(const std::array<int, 3>& size, const std::array<double, 3>& spacing);

/// Memory layout of one rank's arrays, which cover a box of a level.
/// @param box, own  box that the arrays cover, and box of the voxels that this rank owns, in voxels of the whole level
/// @param joined  box that the rank's arrays cover on the next coarser level, in voxels of that level
MultigridLevel PartOfLevel(
  const MultigridLevel& whole, const VoxelBox& box, const VoxelBox& own, const VoxelBox& joined = {});
/// Copy of the level in which all voxels of the box count as owned, for kernels that also process ghost voxels.
MultigridLevel WithGhostsOwned(MultigridLevel level);
/// Box of the voxels of the next coarser level that contain voxels of `box`.
VoxelBox Joined(const MultigridLevel& level, const VoxelBox& box);

/// Copies `arrays` consecutive arrays of values by voxel, x fastest, to the row layout of a level; padding is 0.
template <class Value>
std::vector<float> InRows(const MultigridLevel& level, const std::vector<Value>& values, int arrays = 1)
{
  std::vector<float> rows(static_cast<std::size_t>(level.floats) * arrays, 0.0f);
  const int* const n = level.size;
  std::size_t i = 0;
  for (int plane = 0; plane < arrays * n[2]; ++plane)
  {
    float* const first = rows.data() + std::size_t(plane / n[2]) * level.floats + RowsLead + plane % n[2] * level.plane;
    for (float* row = first; row < first + n[1] * level.pitch; row += level.pitch)
    {
      for (int x = 0; x < n[0]; ++x, ++i)
      {
        row[x] = static_cast<float>(values[i]);
      }
      // the float after the row is a ghost: the voxel at the opposite end, read if the axis is periodic
      row[n[0]] = row[0];
    }
  }
  return rows;
}

/// Copies `arrays` consecutive arrays in the row layout of a level to values by voxel, x fastest.
inline std::vector<float> OfRows(const MultigridLevel& level, const std::vector<float>& rows, int arrays = 1)
{
  const int* const n = level.size;
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(n[0]) * n[1] * n[2] * arrays);
  for (int plane = 0; plane < arrays * n[2]; ++plane)
  {
    auto first = rows.begin() + std::ptrdiff_t(plane / n[2]) * level.floats + RowsLead + plane % n[2] * level.plane;
    for (int y = 0; y < n[1]; ++y, first += level.pitch)
    {
      values.insert(values.end(), first, first + n[0]);
    }
  }
  return values;
}
}
