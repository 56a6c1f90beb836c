#pragma once

#include "Medium/Grid.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// A box of voxels within a grid: its lowest voxel and its size in voxels.
struct VoxelBox
{
  std::array<int, 3> first = { 0, 0, 0 };
  std::array<int, 3> size = { 0, 0, 0 };

  std::size_t VoxelCount() const
  {
    return static_cast<std::size_t>(this->size[0]) * static_cast<std::size_t>(this->size[1]) *
      static_cast<std::size_t>(this->size[2]);
  }
  /// Voxel of the grid at an index of an array over the box.
  std::array<int, 3> VoxelAt(std::size_t index) const
  {
    const std::array<int, 3> at = Grid{ this->size }.VoxelAt(index);
    return { this->first[0] + at[0], this->first[1] + at[1], this->first[2] + at[2] };
  }
  /// Converts a voxel of the grid to indices relative to the first voxel of the box.
  std::array<int, 3> Within(const std::array<int, 3>& voxel) const
  {
    return { voxel[0] - this->first[0], voxel[1] - this->first[1], voxel[2] - this->first[2] };
  }
};

/// The box of the grid `whole` as a grid of its own, at the same position in space.
inline Grid GridOfBox(const VoxelBox& box, const Grid& whole)
{
  Grid grid = whole;
  grid.size = box.size;
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.origin[axis] += box.first[axis] * whole.spacing[axis];
  }
  return grid;
}
}
