#pragma once

#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <vector>

namespace tyndall
{
/// The multigrid levels of a whole grid, the finest first. Each level joins voxels in pairs along the axes whose
/// edges are below 1.9 times the shortest one, until few voxels are left.
/// @param spacing  of voxels: an axis along which they are far shorter is coarsened first
std::vector<MultigridLevel> MultigridLevels(const std::array<int, 3>& size, const std::array<double, 3>& spacing);

/// A part of a level.
/// @param box, own  voxels of the whole grid: those of the arrays, and those that this rank owns
/// @param joined  the box of the next coarser level
MultigridLevel PartOfLevel(
  const MultigridLevel& whole, const VoxelBox& box, const VoxelBox& own, const VoxelBox& joined = {});
/// The level with all voxels of its box owned, as kernels see it that process ghost voxels, too.
MultigridLevel WithGhostsOwned(MultigridLevel level);
/// The box of the next coarser level's voxels that contain voxels of a box.
VoxelBox Joined(const MultigridLevel& level, const VoxelBox& box);

/// Copies one or several arrays of values by voxel, x fastest, to the rows of a level; padding is 0.
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
      row[n[0]] = row[0]; // right ghost, for a periodic axis
    }
  }
  return rows;
}

/// Copies rows of a level, of one or several arrays, to values by voxel, x fastest.
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
