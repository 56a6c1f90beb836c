#pragma once

#include "Device/OpenCL.h"
#include "Medium/FilledBricks.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Where samples stand in memory by bricks, of a medium that is mostly empty.
///
/// A cell is what is between eight samples: cell (i, j, k) has sample (i, j, k) of the grid with its border of one
/// voxel as its lower corner, so that an axis of n voxels has n + 1 cells. A brick of 8^3 cells has a record of all
/// samples at its cells' corners, x fastest, those at its upper faces too, which the next brick has again: what is
/// taken between samples needs one record. Bricks that hold nothing share record 0, of zeros.
struct SampleBricks
{
  std::array<int, 3> count = { 0, 0, 0 }; ///< bricks of cells along each axis
  std::array<int, 3> edges = { 0, 0, 0 }; ///< samples of a record along each axis
  std::vector<cl_int> first;              ///< of each brick, x fastest: the place of its record's first sample
  std::vector<cl_int> bricks;             ///< of each record, the brick; -1: of none

  std::size_t SamplesEach() const
  {
    return static_cast<std::size_t>(this->edges[0]) * static_cast<std::size_t>(this->edges[1]) *
      static_cast<std::size_t>(this->edges[2]);
  }
  std::size_t SampleCount() const { return this->bricks.size() * this->SamplesEach(); }
};

/// @param paired  samples hold also the next one along y: those at the upper faces along y are left out
SampleBricks SampleBricksOf(const FilledBricks& filled, const Grid& grid, bool paired);
}
