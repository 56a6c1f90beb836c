#include "Viewing/Samples/Marching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace tyndall;

namespace
{
TEST(MarchedRows, PatchesOfAllBatchesCoverEveryCellOnce)
{
  std::mt19937 random(7);
  const std::size_t rows = 17, cells = 23;
  for (int trial = 0; trial < 50; ++trial)
  {
    std::vector<int> times(rows * cells, 0);
    std::uniform_int_distribution<std::size_t> sizes(1, 1 + 4 * (trial + 1));
    for (std::size_t begin = 0; begin < times.size();)
    {
      const std::size_t size = std::min(sizes(random), times.size() - begin);
      InPatches(begin, size, cells, [&](const Patch& part) {
        for (std::size_t row = part.row; row < part.row + part.rows; ++row)
        {
          for (std::size_t column = part.column; column < part.column + part.columns; ++column)
          {
            ASSERT_LT(column, cells);
            ASSERT_LT(row, rows);
            ++times[row * cells + column];
          }
        }
      });
      begin += size;
    }
    EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](int n) { return n == 1; })) << "trial " << trial;
  }
}

TEST(MarchedRows, BatchesAreOfWholeRowsUnlessOneTakesTooLong)
{
  EXPECT_EQ(BatchesOfRows(40, 23, 1e3, 0.0, 1.0).whole, 23u);
  const Batches slow = BatchesOfRows(40, 23, 1e9, 0.0, 1.0);
  EXPECT_EQ(slow.whole, 1u);
  EXPECT_EQ(slow.most, 1u);
  EXPECT_EQ(slow.count, 40u * 23u);
}

TEST(MarchedRows, LongestRayCrossesTheDiagonal)
{
  Grid grid;
  grid.size = { 2, 3, 6 };
  EXPECT_DOUBLE_EQ(LongestSteps(grid, 0.5), 15.0); // 7 voxels, and one step more
  EXPECT_NE(StepOption(1e4), StepOption(15.0));
}
}
