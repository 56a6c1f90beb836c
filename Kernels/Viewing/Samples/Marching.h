#pragma once

#include "Device/Batches.h"
#include "Medium/Grid.h"

#include <algorithm>
#include <string>

namespace tyndall
{
/// Steps of the longest straight ray.
/// @param stepSize  voxels
double LongestSteps(const Grid& grid, double stepSize);

/// MANY_STEPS of the kernels that march along rays of so many steps.
std::string StepOption(double longestSteps);

/// Rows of cells of work: whole rows in a batch, or parts of them where a row takes too long to be stopped.
/// @param samples  that a cell takes, at most
/// @param from, to  fractions done that are reported
Batches BatchesOfRows(std::size_t rows, std::size_t cells, double samples, double from, double to);

/// A part of such a batch that is a rectangle.
struct Patch
{
  int column, row;
  std::size_t columns, rows;
};

/// Calls launch(patch) for the rectangles that cells [begin, begin + size) of rows of `cells` consist of.
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
