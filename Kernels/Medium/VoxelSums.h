#pragma once

#include "Device/HostThreads.h"
#include "Medium/Grid.h"

namespace tyndall
{
/// Sum of term(index of the voxel) over all voxels, on all of the host's cores. The order of addition is always the
/// same, and so is the result.
template <class Term>
double SumOverVoxels(const Grid& grid, const Term& term)
{
  return SumInThreads(grid.VoxelCount(), 16384, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i)
    {
      sum += term(i);
    }
    return sum;
  });
}
}
