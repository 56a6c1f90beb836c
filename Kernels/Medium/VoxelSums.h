#pragma once

#include "Device/HostThreads.h"
#include "Medium/Grid.h"

namespace tyndall
{
/// Calls term(voxel) for each voxel, on all of the host's cores; the sum of what it returns, always in the same order.
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
