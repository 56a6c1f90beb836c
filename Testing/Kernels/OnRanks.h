#pragma once

#include "Distribution/Domain.h"
#include "RanksInThreads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

/// Numbers of ranks for which a claim is tested that does not depend on them.
inline auto SomeRanks()
{
  return testing::Values(1, 3);
}

/// A grid on one rank; or on three with uneven blocks, of which the second has no voxels.
inline tyndall::BlockPartition CutFor(const tyndall::Grid& grid, int ranks)
{
  tyndall::BlockPartition partition = tyndall::BlockPartition::Even(grid, 1);
  if (ranks == 3)
  {
    const int axis = static_cast<int>(std::max_element(grid.size.begin(), grid.size.end()) - grid.size.begin());
    tyndall::VoxelBox low = partition.blocks[0], high = low;
    low.size[axis] = high.first[axis] = (grid.size[axis] + 2) / 3;
    high.size[axis] -= low.size[axis];
    partition.blocks = { low, {}, high.VoxelCount() > 0 ? high : tyndall::VoxelBox() };
  }
  return partition;
}

/// Runs work(domain) on one rank, or on three that are threads of this process. Rethrows what they throw.
template <class Work>
void OnRanks(const tyndall::Grid& grid, int ranks, const Work& work)
{
  if (ranks == 1)
  {
    work(tyndall::Domain(grid));
    return;
  }
  tyndall::RunInThreads(
    ranks, [&](tyndall::Communicator& communicator) { work(tyndall::Domain(communicator, CutFor(grid, ranks))); });
}

/// Calls act(voxel of the block, the same voxel of the whole grid), both as places in an array.
template <class Act>
void ForVoxels(const tyndall::Domain& domain, const Act& act)
{
  const tyndall::Grid own = domain.OwnGrid();
  for (std::size_t i = 0; i < own.VoxelCount(); ++i)
  {
    std::array<int, 3> voxel = own.VoxelAt(i);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      voxel[axis] += domain.Own().first[axis];
    }
    act(i, domain.Whole().IndexOf(voxel));
  }
}

/// A block's values among those of the whole grid, and back; as many a voxel as there are.
template <class T>
std::vector<T> BlockOf(const tyndall::Domain& domain, const std::vector<T>& all)
{
  const std::size_t width = all.size() / std::max<std::size_t>(domain.Whole().VoxelCount(), 1);
  std::vector<T> own(domain.Own().VoxelCount() * width);
  ForVoxels(domain,
    [&](std::size_t i, std::size_t there) { std::copy_n(all.data() + there * width, width, own.data() + i * width); });
  return own;
}

template <class T>
void PutBlock(const tyndall::Domain& domain, const std::vector<T>& own, std::vector<T>& all)
{
  const std::size_t width = domain.IsEmpty() ? 0 : own.size() / domain.Own().VoxelCount();
  ForVoxels(domain,
    [&](std::size_t i, std::size_t there) { std::copy_n(own.data() + i * width, width, all.data() + there * width); });
}
