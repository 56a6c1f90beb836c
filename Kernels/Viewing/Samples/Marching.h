#pragma once

#include "Device/Batches.h"
#include "Medium/Grid.h"

#include <algorithm>
#include <string>

namespace tyndall
{
/// Number of steps of the longest straight ray through the grid.
/// @param stepSize  voxels
double LongestSteps(const Grid& grid, double stepSize);

/// Compiler option that sets MANY_STEPS in the marching kernels, for rays of up to `longestSteps` steps.
std::string StepOption(double longestSteps);

/// Splits a grid of work (rows of cells) into batches: whole rows, or parts of rows where a whole row would run too
/// long to be aborted.
/// @param samples  largest number of samples per cell
/// @param from, to  progress that is reported at the begin and the end, in [0, 1]
Batches BatchesOfRows(std::size_t rows, std::size_t cells, double samples, double from, double to);

/// A rectangular part of such a batch.
struct Patch
{
  int column, row;
  std::size_t columns, rows;
};

/// Splits cells [begin, begin + size), numbered row by row in rows of `cells`, into rectangles and calls launch(patch)
/// for each.
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
