#pragma once

#include "Device/Batches.h"
#include "Device/Device.h"
#include "Medium/Grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace tyndall
{
/// Number of steps of the longest straight ray through the grid.
/// @param stepSize  length of a step, voxels
inline double LongestSteps(const Grid& grid, double stepSize)
{
  return std::hypot(grid.size[0], grid.size[1], grid.size[2]) / stepSize + 1.0;
}

/// Compiler option that sets MANY_STEPS in the marching kernels, for rays of up to `longestSteps` steps.
inline std::string StepOption(double longestSteps)
{
  // Number of steps from which accumulated rounding errors reach 1e-4.
  constexpr double ManySteps = 4096.0;
  return Define("MANY_STEPS", longestSteps > ManySteps);
}

/// Splits the work of a kernel on a 2D grid of `rows` rows of `cells` cells into batches. A batch has complete rows;
/// where an entire row would run too long to be aborted, it has a section of one row.
/// @param samples  largest number of samples of the medium that the kernel takes per cell
/// @param from, to  progress that is reported at the start and at the end, in [0, 1]
inline Batches BatchesOfRows(std::size_t rows, std::size_t cells, double samples, double from, double to)
{
  // Number of samples between two progress reports. They take less than a second on one old CPU core.
  constexpr double SamplesAtOnce = 3.2e7;
  const double atOnce = std::max(SamplesAtOnce / std::max(samples, 1.0), 1.0);
  Batches batches;
  batches.count = rows * cells;
  batches.whole = atOnce >= static_cast<double>(cells) ? cells : 1;
  batches.most = static_cast<std::size_t>(std::min(atOnce, static_cast<double>(batches.count)));
  batches.first = std::max<std::size_t>(1, rows / 8) * cells;
  batches.from = from;
  batches.to = to;
  return batches;
}

/// A rectangle of cells, within one of the batches into which BatchesOfRows splits the work of a kernel.
struct Patch
{
  int column, row;
  std::size_t columns, rows;
};

/// Splits cells [begin, begin + size), numbered row by row in rows of `cells` cells, into rectangles and calls
/// launch(patch) for each.
template <class Launch>
void InPatches(std::size_t begin, std::size_t size, std::size_t cells, const Launch& launch)
{
  for (const std::size_t end = begin + size; begin < end;)
  {
    const std::size_t column = begin % cells;
    const bool whole = column == 0 && end - begin >= cells;
    const std::size_t columns = whole ? cells : std::min(cells - column, end - begin);
    const std::size_t rows = whole ? (end - begin) / cells : 1;
    launch(Patch{ static_cast<int>(column), static_cast<int>(begin / cells), columns, rows });
    begin += columns * rows;
  }
}
}
