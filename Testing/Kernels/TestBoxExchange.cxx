#include "Distribution/BoxExchange.h"
#include "Distribution/RanksInThreads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

using namespace tyndall;

namespace
{
/// Two numbers of a voxel that no other has.
std::vector<float> NumbersOf(const Grid& grid, const VoxelBox& box)
{
  std::vector<float> numbers;
  for (int z = box.first[2]; z < EndOf(box, 2); ++z)
  {
    for (int y = box.first[1]; y < EndOf(box, 1); ++y)
    {
      for (int x = box.first[0]; x < EndOf(box, 0); ++x)
      {
        const float number = static_cast<float>(grid.IndexOf({ x, y, z }));
        numbers.insert(numbers.end(), { number, -number });
      }
    }
  }
  return numbers;
}

/// The block and as many layers around it.
VoxelBox Around(const VoxelBox& block, int layers, const Grid& grid)
{
  VoxelBox box = block;
  for (int axis = 0; axis < 3 && block.VoxelCount() > 0; ++axis)
  {
    box.first[axis] = std::max(0, block.first[axis] - layers);
    box.size[axis] = std::min(grid.size[axis], EndOf(block, axis) + layers) - box.first[axis];
  }
  return box;
}
}

TEST(BoxExchange, BringsValuesOfNeighboursHoweverManyLayersAreWanted)
{
  Grid grid;
  grid.size = { 5, 3, 4 };
  for (const int ranks : { 1, 2, 3, 7, 64 }) // at last more than voxels
  {
    const BlockPartition partition = BlockPartition::Even(grid, ranks);
    for (const int layers : { 0, 1, 4 })
    {
      std::vector<VoxelBox> wanted;
      for (const VoxelBox& block : partition.blocks)
      {
        wanted.push_back(Around(block, layers, grid));
      }
      RunInThreads(ranks, [&](Communicator& communicator) {
        const int rank = communicator.Rank();
        const std::vector<float> own = NumbersOf(grid, partition.blocks[rank]);
        EXPECT_EQ(ValuesInBox(communicator, partition, wanted, own, 2), NumbersOf(grid, wanted[rank]))
          << ranks << " ranks, " << layers << " layers, rank " << rank;
      });
    }
  }
}
