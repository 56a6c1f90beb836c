#include "Distribution/BoxExchange.h"
#include "Distribution/BrickedBytes.h"
#include "Distribution/Halo.h"
#include "RanksInThreads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
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

TEST(BrickedBytes, AreOfAllRanksWhatEachHas)
{
  Grid grid;
  grid.size = { 21, 9, 17 };
  std::vector<std::uint8_t> all;
  for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
  {
    const std::array<int, 3> at = grid.VoxelAt(i);
    all.push_back(static_cast<std::uint8_t>(at[0] > 9 ? 3 : at[2] < 8 ? 200 : i % 5));
  }
  for (const int ranks : { 1, 3, 7 })
  {
    const BlockPartition partition = BlockPartition::Even(grid, ranks);
    for (const bool some : { false, true })
    {
      RunInThreads(ranks, [&](Communicator& communicator) {
        const VoxelBox& box = partition.blocks[static_cast<std::size_t>(communicator.Rank())];
        std::vector<std::uint8_t> own;
        for (std::size_t i = 0; i < all.size(); ++i)
        {
          if (Holds(box, grid.VoxelAt(i).data()))
          {
            own.push_back(all[i]);
          }
        }
        // The first rank wants a box whose bricks are not uniform, and the others nothing.
        std::vector<VoxelBox> wanted(partition.blocks.size());
        wanted[0] = { { 1, 0, 7 }, { 9, 9, 10 } };
        const BrickedBytes bytes =
          some ? BytesOfBoxes(communicator, partition, own, wanted) : BytesOfAll(communicator, partition, own);
        const VoxelBox there =
          some ? wanted[static_cast<std::size_t>(communicator.Rank())] : VoxelBox{ { 0, 0, 0 }, grid.size };
        for (std::size_t i = 0; i < all.size(); ++i)
        {
          if (Holds(there, grid.VoxelAt(i).data()))
          {
            ASSERT_EQ(bytes.At(grid.VoxelAt(i)), all[i]) << i << " of " << ranks;
          }
        }
        if (!some || there.VoxelCount() == 0)
        {
          EXPECT_EQ(bytes.Dense().size(), (some ? 0 : 10) * BrickedBytes::Voxels); // of 18
        }
      });
    }
  }
}

TEST(GhostCells, AreThoseOfTheirOwners)
{
  const Grid grid = { { 5, 4, 3 } };
  const BlockPartition partition = BlockPartition::Even(grid, 4);
  std::vector<std::vector<VoxelBox>> ghosts;
  for (const VoxelBox& block : partition.blocks)
  {
    ghosts.push_back(LayersBeside(block, grid.size));
  }
  RunInThreads(4, [&](Communicator& communicator) {
    const int rank = communicator.Rank();
    const VoxelBox held = Hull(partition.blocks[rank], ghosts[rank]);
    const GhostCells cells(communicator, partition.blocks, ghosts, held);
    std::vector<float> number(grid.VoxelCount());
    std::iota(number.begin(), number.end(), 1.0f);
    const std::vector<float> expected = PartOf(number, { {}, grid.size }, held, 1);
    std::vector<double> values(held.VoxelCount(), 0.0);
    Grid ofHeld;
    ofHeld.size = held.size;
    const auto isIn = [&](const VoxelBox& box, std::size_t i) {
      const std::array<int, 3> at = ofHeld.VoxelAt(i);
      return Common(box, { { at[0] + held.first[0], at[1] + held.first[1], at[2] + held.first[2] }, { 1, 1, 1 } })
               .VoxelCount() == 1;
    };
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      values[i] = isIn(partition.blocks[rank], i) ? expected[i] : 0.0;
    }
    cells.Fill(values.data(), 1, 0);
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      bool known = isIn(partition.blocks[rank], i);
      for (const VoxelBox& box : ghosts[rank])
      {
        known = known || isIn(box, i);
      }
      EXPECT_EQ(values[i], known ? expected[i] : 0.0) << "rank " << rank << ", place " << i;
    }
  });
}
