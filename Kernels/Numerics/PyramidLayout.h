#pragma once

#include "Device/OpenCL.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Memory layout of a pyramid over a grid, its levels stored one after the other. Node (i, j, k) of level l covers the
/// voxels [2^l (i, j, k), 2^l (i+1, j+1, k+1)), clipped to the grid; x fastest.
struct PyramidLayout
{
  explicit PyramidLayout(const std::array<int, 3>& size); ///< computes the layout for a grid of `size` voxels

  /// Number of levels, 1 + ceil(log2(longest edge in voxels)).
  int LevelCount() const { return static_cast<int>(this->sizes.size()); }
  int Top() const { return this->LevelCount() - 1; } ///< index of the level with a single node

  std::vector<std::array<int, 3>> sizes; ///< nodes per axis of each level; level 0 is the grid
  /// Index of the first node of each level from 1 on; level 0 is not stored in the buffer.
  std::vector<std::size_t> offsets;
  /// Number of nodes of the levels from 1 on: a seventh of the voxels of a large cube.
  std::size_t nodeCount = 0;
};

/// Work-group size of the kernels over a pyramid's nodes (one work-item per node). It is equal for all levels, so that
/// each kernel is compiled once.
inline cl::NDRange PyramidGroup()
{
  return cl::NDRange(32, 8, 1);
}
/// Global size, rounded up to work-groups, of a kernel over the `nodes` of one level of a pyramid.
cl::NDRange PyramidRange(const std::array<int, 3>& nodes);
}
