#pragma once

#include "Refraction/Voxelization/Voxelization.h"

#include <vector>

/// What CountSamplesInside hands out slab by slab, as a whole.
struct WholeCounts
{
  std::vector<std::vector<cl_ushort>> counts; ///< [mesh][voxel], x fastest
  std::vector<tyndall::WindingNumbers> windings;
};

inline WholeCounts CountWhole(tyndall::Device& device, const tyndall::Grid& grid,
  const std::vector<tyndall::OrientedMesh>& meshes, const tyndall::VoxelizationSettings& settings = {},
  const tyndall::Monitor& monitor = {})
{
  WholeCounts whole;
  whole.counts.assign(meshes.size(), std::vector<cl_ushort>(grid.VoxelCount(), 9999));
  const auto take = [&](const tyndall::SamplesInside& inside) {
    const std::vector<cl_ushort> slab = inside.counts.Read();
    for (std::size_t run = 0; run < inside.runs; ++run)
    {
      const auto begin = slab.begin() + run * inside.length;
      std::copy(begin, begin + inside.length, whole.counts[inside.mesh].begin() + inside.first + run * inside.stride);
    }
  };
  whole.windings =
    tyndall::CountSamplesInside(device, grid, tyndall::CountedVoxels::All(grid), meshes, settings, take, monitor);
  return whole;
}
