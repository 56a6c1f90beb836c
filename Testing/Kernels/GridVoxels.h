#pragma once

#include <array>
#include <cstddef>

/// Calls act(number of the voxel, x, y, z) for each voxel of a grid, x fastest.
template <class Act>
void ForGridVoxels(const std::array<int, 3>& size, const Act& act)
{
  std::size_t i = 0;
  for (int z = 0; z < size[2]; ++z)
  {
    for (int y = 0; y < size[1]; ++y)
    {
      for (int x = 0; x < size[0]; ++x, ++i)
      {
        act(i, x, y, z);
      }
    }
  }
}
