#include "Distribution/BlockPartition.h"

#include "Device/Errors.h"

#include <algorithm>
#include <string>

namespace tyndall
{
namespace
{
/// Divides a box into `parts` blocks by recursive bisection, and stores them in `blocks` for the ranks from `first` on.
void Cut(const VoxelBox& box, int parts, int first, std::vector<VoxelBox>& blocks)
{
  const int axis = static_cast<int>(std::max_element(box.size.begin(), box.size.end()) - box.size.begin());
  if (parts == 1 || box.size[axis] < 2)
  {
    blocks[first] = box;
    return;
  }
  const int lower = parts / 2;
  VoxelBox below = box, above = box;
  below.size[axis] = std::clamp(static_cast<int>(static_cast<long>(box.size[axis]) * lower / parts), 1, box.size[axis]);
  above.first[axis] += below.size[axis];
  above.size[axis] -= below.size[axis];
  Cut(below, lower, first, blocks);
  Cut(above, parts - lower, first + lower, blocks);
}
}

void BlockPartition::Check() const
{
  const VoxelBox all = { { 0, 0, 0 }, this->whole.size };
  std::size_t voxels = 0;
  for (std::size_t a = 0; a < this->blocks.size(); ++a)
  {
    const std::size_t own = this->blocks[a].VoxelCount();
    voxels += own;
    Require(own == 0 || Common(this->blocks[a], all).VoxelCount() == own,
      "The block of rank " + std::to_string(a) + " reaches beyond the grid.");
    for (std::size_t b = 0; b < a; ++b)
    {
      Require(Common(this->blocks[a], this->blocks[b]).VoxelCount() == 0,
        "The blocks of ranks " + std::to_string(b) + " and " + std::to_string(a) + " have voxels in common.");
    }
  }
  Require(voxels == this->whole.VoxelCount(),
    "Blocks hold " + std::to_string(voxels) + " of the grid's " + std::to_string(this->whole.VoxelCount()) +
      " voxels: each must be in one of them.");
}

Grid BlockPartition::OwnGrid(int rank) const
{
  const VoxelBox& block = this->blocks.at(rank);
  Grid grid = GridOfBox(block, this->whole);
  grid.size = block.VoxelCount() > 0 ? block.size : std::array<int, 3>{ 0, 0, 0 };
  return grid;
}

BlockPartition BlockPartition::Even(const Grid& whole, int ranks)
{
  BlockPartition partition = { whole, std::vector<VoxelBox>(ranks) };
  Cut({ { 0, 0, 0 }, whole.size }, ranks, 0, partition.blocks);
  return partition;
}

VoxelBox Common(const VoxelBox& a, const VoxelBox& b)
{
  VoxelBox common;
  for (int axis = 0; axis < 3; ++axis)
  {
    common.first[axis] = std::max(a.first[axis], b.first[axis]);
    common.size[axis] = std::max(0, std::min(EndOf(a, axis), EndOf(b, axis)) - common.first[axis]);
  }
  return common;
}

bool Holds(const VoxelBox& box, const int* voxel)
{
  bool holds = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    holds = holds && voxel[axis] >= box.first[axis] && voxel[axis] < EndOf(box, axis);
  }
  return holds;
}

VoxelBox Grown(const VoxelBox& box, int by, const Grid& whole)
{
  VoxelBox grown = box;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int end = std::min(EndOf(box, axis) + by, whole.size[axis]);
    grown.first[axis] = std::max(box.first[axis] - by, 0);
    grown.size[axis] = end - grown.first[axis];
  }
  return grown;
}

namespace
{
bool AreNear(const VoxelBox& a, const VoxelBox& b, int axis, int reach, int period)
{
  const auto meet = [&](int shift) {
    return a.first[axis] - reach < EndOf(b, axis) + shift && b.first[axis] + shift < EndOf(a, axis) + reach;
  };
  return meet(0) || (period > 0 && (meet(-period) || meet(period)));
}
}

std::vector<int> NeighboursOf(const BlockPartition& partition, int rank, int reach, const std::array<bool, 3>& periodic)
{
  std::vector<int> neighbours;
  if (partition.blocks.at(rank).VoxelCount() == 0)
  {
    return neighbours;
  }
  for (int other = 0; other < static_cast<int>(partition.blocks.size()); ++other)
  {
    bool near = other != rank && partition.blocks[other].VoxelCount() > 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int period = periodic[axis] ? partition.whole.size[axis] : 0;
      near = near && AreNear(partition.blocks[rank], partition.blocks[other], axis, reach, period);
    }
    if (near)
    {
      neighbours.push_back(other);
    }
  }
  return neighbours;
}
}
