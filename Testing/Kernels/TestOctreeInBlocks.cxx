#include "DeviceTest.h"
#include "MediumInBlocks.h"

#include "Distribution/BrickedBytes.h"
#include "Distribution/RanksInThreads.h"
#include "Refraction/Octree/OctreeInBlocks.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace tyndall;
using testing::HasSubstr;

namespace
{
/// Waves of the index and of extinction, whose nodes are of many sizes, and with `sharp` voxels by chance among them.
struct Waves
{
  Waves(std::array<int, 3> size, int components, bool sharp)
  {
    this->medium.grid.size = size;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    for (std::size_t i = 0; i < this->medium.grid.VoxelCount(); ++i)
    {
      const std::array<int, 3> at = this->medium.grid.VoxelAt(i);
      const double wave = std::sin(0.05 * at[0]) * std::cos(0.04 * at[1]) * std::sin(0.5 + 0.06 * at[2]);
      this->index.push_back(static_cast<float>(1.3 + 0.2 * wave + (sharp && chance(random) < 0.02 ? 0.1 : 0.0)));
      for (int c = 0; c < components; ++c)
      {
        this->sigma.push_back(static_cast<float>(0.3 + 0.2 * std::cos(0.03 * at[c]) + (at[c] > 12 ? 0.5 : 0.0)));
      }
    }
    this->components = components;
    this->Attach();
  }
  void Attach()
  {
    this->medium.sigma_a = { nullptr, 1 };
    this->medium.sigma_s = { this->sigma.data(), this->components };
  }
  Waves Part(const VoxelBox& box) const
  {
    Waves part = *this;
    const VoxelBox all = { {}, this->medium.grid.size };
    part.medium.grid.size = box.size;
    part.index = PartOf(this->index, all, box, 1);
    part.sigma = PartOf(this->sigma, all, box, this->components);
    part.Attach();
    return part;
  }

  Medium medium;
  std::vector<float> index, sigma;
  int components = 1;
};

class OctreeInBlocksTest : public DeviceTest
{
protected:
  static void ExpectTheWhole(const Waves& waves, const OctreeSettings& settings, const BlockPartition& partition)
  {
    const Octree whole = BuildOctree(waves.medium, { waves.index.data(), 1 }, settings);
    const int largest = *std::max_element(whole.levels.begin(), whole.levels.end());
    RunInThreads(static_cast<int>(partition.blocks.size()), [&](Communicator& communicator) {
      const VoxelBox& own = partition.blocks[static_cast<std::size_t>(communicator.Rank())];
      const Waves part = waves.Part(own);
      const Octree octree =
        BuildOctreeInBlocks(communicator, partition, part.medium, { part.index.data(), 1 }, settings);
      ASSERT_EQ(octree.levels.size(), own.VoxelCount());
      const std::array<std::size_t, 3> strides = waves.medium.grid.Strides();
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < octree.levels.size(); ++i)
      {
        const std::array<int, 3> at = part.medium.grid.VoxelAt(i);
        const std::size_t there = static_cast<std::size_t>(own.first[0] + at[0]) +
          static_cast<std::size_t>(own.first[1] + at[1]) * strides[1] +
          static_cast<std::size_t>(own.first[2] + at[2]) * strides[2];
        wrong += octree.levels[i] == whole.levels[there] ? 0 : 1;
      }
      EXPECT_EQ(wrong, 0u) << partition.blocks.size() << " blocks, nodes of up to level " << largest;
      EXPECT_EQ(octree.topLevel, whole.topLevel);
      EXPECT_EQ(octree.leftOut, whole.leftOut);
    });
  }

  static BlockPartition Cut(const Grid& grid, const std::vector<int>& cuts)
  {
    BlockPartition partition;
    partition.whole = grid;
    int first = 0;
    for (const int cut : cuts)
    {
      partition.blocks.push_back({ { 0, first, 0 }, { grid.size[0], cut - first, grid.size[2] } });
      first = cut;
    }
    return partition;
  }
};

TEST_F(OctreeInBlocksTest, HasTheLevelsOfTheWhole)
{
  for (const std::array<int, 3>& size :
    { std::array<int, 3>{ 32, 32, 32 }, std::array<int, 3>{ 33, 20, 17 }, std::array<int, 3>{ 7, 1, 41 } })
  {
    for (const bool sharp : { false, true })
    {
      const Waves waves(size, 1, sharp);
      for (const int ranks : { 1, 3, 8 })
      {
        ExpectTheWhole(waves, { 0.02 }, BlockPartition::Even(waves.medium.grid, ranks));
      }
    }
  }
}

TEST_F(OctreeInBlocksTest, RestrictsNodesByExtinctionToo)
{
  const Waves waves({ 24, 24, 24 }, 3, false);
  for (const double tolerance : { 0.0, 0.3, 3.0 })
  {
    ExpectTheWhole(waves, { 0.05, true, tolerance }, BlockPartition::Even(waves.medium.grid, 5));
  }
}

TEST_F(OctreeInBlocksTest, TakesUnevenAndEmptyBlocksAndSingleVoxels)
{
  const Waves waves({ 19, 23, 9 }, 1, true);
  ExpectTheWhole(waves, { 0.03 }, Cut(waves.medium.grid, { 1, 1, 6, 22, 23 }));
  const Waves small({ 3, 2, 2 }, 1, true);
  BlockPartition voxels = BlockPartition::Even(small.medium.grid, 13); // the last has nothing
  ExpectTheWhole(small, { 0.03 }, voxels);
  const Waves one({ 1, 1, 1 }, 1, false);
  ExpectTheWhole(one, { 0.03 }, BlockPartition::Even(one.medium.grid, 2));
}

TEST_F(OctreeInBlocksTest, IsOneNodeWhereAllIsConstant)
{
  Waves waves({ 9, 10, 11 }, 1, false);
  std::fill(waves.index.begin(), waves.index.end(), 1.25f);
  std::fill(waves.sigma.begin(), waves.sigma.end(), 0.5f);
  waves.Attach();
  ExpectTheWhole(waves, { 0.0, true, 0.0 }, BlockPartition::Even(waves.medium.grid, 3));
}

TEST_F(OctreeInBlocksTest, NamesAVoxelOfTheWholeOnEveryRank)
{
  Waves waves({ 8, 8, 8 }, 1, false);
  waves.index[waves.medium.grid.IndexOf({ 2, 3, 7 })] = -1.0f;
  const BlockPartition partition = BlockPartition::Even(waves.medium.grid, 4);
  RunInThreads(4, [&](Communicator& communicator) {
    const Waves part = waves.Part(partition.blocks[static_cast<std::size_t>(communicator.Rank())]);
    try
    {
      BuildOctreeInBlocks(communicator, partition, part.medium, { part.index.data(), 1 }, {});
      ADD_FAILURE() << "taken on rank " << communicator.Rank();
    }
    catch (const InvalidInput& error)
    {
      EXPECT_THAT(error.what(), HasSubstr("(2, 3, 7)"));
    }
  });
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
        // Of some the first rank wants what is not even, and the others nothing.
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
}
