#pragma once

#include <array>
#include <cstddef>

namespace tyndall
{
/// A box of voxels within a grid.
struct VoxelBox
{
  std::array<int, 3> first = { 0, 0, 0 };
  std::array<int, 3> size = { 0, 0, 0 };

  std::size_t VoxelCount() const
  {
    return static_cast<std::size_t>(this->size[0]) * static_cast<std::size_t>(this->size[1]) *
      static_cast<std::size_t>(this->size[2]);
  }
};
}
