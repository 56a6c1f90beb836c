#pragma once

#include "Device/OpenCL.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// How the levels of a pyramid over a grid lie one after the other in a buffer. Node (i, j, k) of level l covers the
/// voxels [2^l (i, j, k), 2^l (i+1, j+1, k+1)), as far as the grid has them; x fastest.
struct PyramidLayout
{
  explicit PyramidLayout(const std::array<int, 3>& size); ///< of the grid

  int LevelCount() const { return static_cast<int>(this->sizes.size()); } ///< 1 + ceil(log2(longest edge))
  int Top() const { return this->LevelCount() - 1; }                      ///< the level of the one node over all

  std::vector<std::array<int, 3>> sizes; ///< nodes per axis of each level; level 0 is the grid itself
  std::vector<std::size_t> offsets;      ///< where a level from 1 on begins, nodes; level 0 is in no pyramid's buffer
  std::size_t nodeCount = 0;             ///< nodes of the levels from 1 on: a seventh of a large cube's voxels
};

/// How the kernels of the pyramids run: a work-item per node, rows of nodes in groups of one size for every level, so
/// that each kernel is compiled once.
inline cl::NDRange PyramidGroup()
{
  return cl::NDRange(32, 8, 1);
}
cl::NDRange PyramidRange(const std::array<int, 3>& nodes);
}
