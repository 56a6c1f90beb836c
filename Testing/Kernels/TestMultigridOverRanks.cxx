// The linear system of a grid that is spread over ranks: what it finds must not depend on the blocks.

#include "DeviceTest.h"
#include "RandomMatrix.h"

#include "Distribution/BoxExchange.h"
#include "Distribution/GhostCells.h"
#include "Distribution/RanksInThreads.h"
#include "LightPropagation/Diffusion/MultigridOverRanks.h"

#include <algorithm>
#include <mutex>
#include <numeric>
#include <string>

using namespace tyndall;

namespace
{
/// What ranks found together.
struct Found
{
  std::vector<double> values; ///< of the whole
  int iterations = 0;
  std::size_t bytes = 0; ///< that all sent
};

std::vector<float> Floats(const std::vector<double>& values)
{
  return { values.begin(), values.end() };
}

std::vector<double> ByChance(std::size_t count)
{
  std::vector<double> values(count);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::generate(values.begin(), values.end(), [&] { return uniform(random); });
  return values;
}

/// Values of a box that may reach beyond the grid's ends, where its other side is.
std::vector<float> PartRoundAxes(const std::vector<float>& values, const Grid& whole, const VoxelBox& box)
{
  Grid ofBox;
  ofBox.size = box.size;
  std::vector<float> part;
  for (std::size_t i = 0; i < box.VoxelCount(); ++i)
  {
    std::array<int, 3> voxel = ofBox.VoxelAt(i);
    for (int axis = 0; axis < 3; ++axis)
    {
      voxel[axis] = (voxel[axis] + box.first[axis] + whole.size[axis]) % whole.size[axis];
    }
    part.push_back(values[whole.IndexOf(voxel)]);
  }
  return part;
}

/// Of a right-hand side of the whole.
Found SolveOverRanks(const RandomMatrix& matrix, const std::vector<double>& right, const BlockPartition& partition,
  std::size_t gatherAtMost, double reduction, const std::array<bool, 3>& periodic = {})
{
  Found found;
  found.values.resize(right.size());
  std::mutex guard;
  RunInThreads(static_cast<int>(partition.blocks.size()), [&](Communicator& communicator) {
    MultigridOverRanks solver(communicator, partition, periodic, gatherAtMost);
    const VoxelBox& held = solver.Held();
    const auto part = [&](const std::vector<float>& values) { return PartRoundAxes(values, partition.whole, held); };
    solver.SetMatrix({ part(matrix.Conductances(0)), part(matrix.Conductances(1)), part(matrix.Conductances(2)) },
      part(matrix.Losses()));
    std::vector<double> values(held.VoxelCount(), 0.0);
    const int iterations = solver.Solve(values, part(Floats(right)), 1.0, reduction);
    const std::lock_guard<std::mutex> lock(guard);
    found.iterations = iterations;
    found.bytes += communicator.Sent().bytes;
    const VoxelBox& block = partition.blocks[communicator.Rank()];
    Grid ofHeld;
    ofHeld.size = held.size;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      std::array<int, 3> voxel = ofHeld.VoxelAt(i);
      bool own = true;
      for (int axis = 0; axis < 3; ++axis)
      {
        voxel[axis] += held.first[axis];
        own = own && voxel[axis] >= block.first[axis] && voxel[axis] < EndOf(block, axis);
      }
      if (own)
      {
        found.values[partition.whole.IndexOf(voxel)] = values[i];
      }
    }
  });
  return found;
}

double LargestDifference(const std::vector<double>& a, const std::vector<double>& b)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  return largest;
}
}

TEST(MultigridOverRanks, FindsWhatTheMatrixWasMultipliedWithWhateverTheBlocks)
{
  for (const std::array<int, 3>& size :
    std::vector<std::array<int, 3>>{ { 23, 17, 40 }, { 16, 16, 16 }, { 5, 3, 2 }, { 29, 1, 9 }, { 1, 1, 64 } })
  {
    const RandomMatrix matrix(size, {}, 1.0);
    const Grid grid = { size };
    const std::vector<double> truth = ByChance(grid.VoxelCount());
    const std::vector<double> right = matrix.Times(truth);
    for (const int ranks : { 1, 3, 8 })
    {
      SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]) +
        " on " + std::to_string(ranks) + " ranks");
      const Found found = SolveOverRanks(matrix, right, BlockPartition::Even(grid, ranks), 64, 1e-6);
      EXPECT_LT(LargestDifference(found.values, truth), 1e-5);
      EXPECT_LE(found.iterations, 25);
    }
  }
}

/// Blocks that have the axis from end to end, and such that do not; of one cell, and none.
TEST(MultigridOverRanks, GoesRoundPeriodicAxes)
{
  for (const std::array<int, 3>& size : std::vector<std::array<int, 3>>{ { 23, 17, 10 }, { 2, 1, 3 }, { 16, 16, 16 } })
  {
    for (const std::array<bool, 3>& periodic :
      std::vector<std::array<bool, 3>>{ { true, false, true }, { true, true, true } })
    {
      const RandomMatrix matrix(size, periodic, 1.0);
      const Grid grid = { size };
      const std::vector<double> truth = ByChance(grid.VoxelCount());
      const std::vector<double> right = matrix.Times(truth);
      int iterations = 0; // of one rank
      for (const int ranks : { 1, 3, 8 })
      {
        SCOPED_TRACE(std::to_string(size[0]) + " voxels on " + std::to_string(ranks) + " ranks");
        const Found found = SolveOverRanks(matrix, right, BlockPartition::Even(grid, ranks), 64, 1e-6, periodic);
        EXPECT_LT(LargestDifference(found.values, truth), 1e-5);
        iterations = ranks == 1 ? found.iterations : iterations;
        EXPECT_EQ(found.iterations, iterations);
        EXPECT_LE(found.iterations, 25);
      }
    }
  }
}

/// Blocks that end on odd voxels, of one voxel's width, and none: cells are those of the whole, and so is each step.
TEST(MultigridOverRanks, GoesTheSameWayInUnevenBlocks)
{
  const Grid grid = { { 21, 18, 15 } };
  const RandomMatrix matrix(grid.size, {}, 100.0);
  std::vector<double> right(grid.VoxelCount(), 0.0);
  right[grid.IndexOf({ 7, 6, 5 })] = 1.0;
  right[grid.IndexOf({ 15, 1, 9 })] = 3.0;
  const Found alone = SolveOverRanks(matrix, right, BlockPartition::Even(grid, 1), 64, 1e-3);
  const std::vector<VoxelBox> uneven = { { { 0, 0, 0 }, { 7, 18, 15 } }, { { 7, 0, 0 }, { 1, 18, 15 } }, {},
    { { 8, 0, 0 }, { 13, 5, 15 } }, { { 8, 5, 0 }, { 13, 13, 1 } }, { { 8, 5, 1 }, { 13, 13, 14 } } };
  for (const std::size_t gatherAtMost : { std::size_t(64), std::size_t(100000) })
  {
    const Found found = SolveOverRanks(matrix, right, { grid, uneven }, gatherAtMost, 1e-3);
    EXPECT_EQ(found.iterations, alone.iterations);
    EXPECT_LT(LargestDifference(found.values, alone.values),
      1e-9 * *std::max_element(alone.values.begin(), alone.values.end()));
  }
}

TEST(MultigridOverRanks, TakesHardlyMoreIterationsOnMoreVoxels)
{
  int few = 0;
  for (const std::array<int, 3>& size : std::vector<std::array<int, 3>>{ { 12, 9, 16 }, { 72, 60, 96 } })
  {
    const Grid grid = { size };
    const RandomMatrix matrix(size, {}, 1.0);
    std::vector<double> right(grid.VoxelCount(), 0.0);
    right[right.size() / 3] = 1.0;
    const int iterations = SolveOverRanks(matrix, right, BlockPartition::Even(grid, 3), 64, 1e-4).iterations;
    few = few > 0 ? few : iterations;
    EXPECT_LE(iterations, few + 2);
  }
  EXPECT_GT(few, 1);
}

TEST(GhostCells, AreThoseOfTheirOwnersAndGoBackToThem)
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
    std::vector<double> values(held.VoxelCount(), 0.0), ones(held.VoxelCount(), 0.0);
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
    cells.Fill(values);
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      bool known = isIn(partition.blocks[rank], i);
      for (const VoxelBox& box : ghosts[rank])
      {
        known = known || isIn(box, i);
      }
      EXPECT_EQ(values[i], known ? expected[i] : 0.0) << "rank " << rank << ", place " << i;
      ones[i] = known ? 1.0 : 0.0;
    }
    cells.AddToOwners(ones);
    for (std::size_t i = 0; i < ones.size(); ++i)
    {
      int holders = 1;
      for (int other = 0; other < 4 && isIn(partition.blocks[rank], i); ++other)
      {
        for (const VoxelBox& box : ghosts[other])
        {
          holders += isIn(box, i);
        }
      }
      if (isIn(partition.blocks[rank], i))
      {
        EXPECT_EQ(ones[i], holders) << "rank " << rank << ", place " << i;
      }
    }
  });
}
