#pragma once

#include "Device/OpenCL.h"
#include "Medium/FilledBricks.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Memory layout of samples in bricks, for a medium that is mostly empty.
///
/// A cell is the cube between eight neighbouring samples: cell (i, j, k) has sample (i, j, k) of the grid with its
/// border of one voxel as its lower corner, so an axis of n voxels has n + 1 cells. A brick of 8^3 cells owns a record:
/// all samples at its cells' corners, x fastest, including those on its upper faces, which the next brick's record
/// repeats, so that interpolation reads one record only. Empty bricks share record 0, which is zero.
struct SampleBricks
{
  std::array<int, 3> count = { 0, 0, 0 }; ///< bricks of cells along each axis
  std::array<int, 3> edges = { 0, 0, 0 }; ///< samples of a record along each axis
  std::vector<cl_int> first;              ///< index of the first sample of each brick's record, bricks x fastest
  std::vector<cl_int> bricks;             ///< the brick that owns each record; -1: none

  std::size_t SamplesEach() const
  {
    return static_cast<std::size_t>(this->edges[0]) * static_cast<std::size_t>(this->edges[1]) *
      static_cast<std::size_t>(this->edges[2]);
  }
  std::size_t SampleCount() const { return this->bricks.size() * this->SamplesEach(); }
};

/// @param paired  each sample also holds the next one along y, so the samples on the upper y faces are left out
SampleBricks SampleBricksOf(const FilledBricks& filled, const Grid& grid, bool paired);
}
