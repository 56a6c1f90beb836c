#include "Medium/Grid.h"

#include <gtest/gtest.h>

using namespace tyndall;

TEST(Grid, CountsVoxelsAlongXFirst)
{
  Grid grid;
  grid.size = { 4, 3, 2 };
  std::size_t index = 0;
  for (int k = 0; k < 2; ++k)
  {
    for (int j = 0; j < 3; ++j)
    {
      for (int i = 0; i < 4; ++i, ++index)
      {
        const std::array<int, 3> voxel = { i, j, k };
        EXPECT_EQ(grid.IndexOf(voxel), index);
        EXPECT_EQ(grid.VoxelAt(index), voxel);
      }
    }
  }
  EXPECT_EQ(index, grid.VoxelCount());
}

TEST(Grid, StepsToTheNextVoxelOfEachAxis)
{
  Grid grid;
  grid.size = { 4, 3, 2 };
  for (int axis = 0; axis < 3; ++axis)
  {
    std::array<int, 3> next = { 0, 0, 0 };
    next[axis] = 1;
    EXPECT_EQ(grid.IndexOf(next), grid.Strides()[axis]) << axis;
  }
}
