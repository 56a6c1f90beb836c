#include "Medium/OpticalSize.h"

#include <gtest/gtest.h>

#include <vector>

using namespace tyndall;

TEST(OpticalSize, IsThatOfTheThickestRow)
{
  Grid grid;
  grid.size = { 4, 3, 2 };
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.spacing = { 1.0, 1.0, 1.0 };
    grid.spacing[axis] = 10.0;
    std::vector<float> density(grid.VoxelCount(), 0.0f);
    std::array<int, 3> voxel = { 1, 2, 1 };
    for (voxel[axis] = 0; voxel[axis] < grid.size[axis]; ++voxel[axis])
    {
      density[grid.IndexOf(voxel)] = 0.5f;
    }
    const OpticalSize size = OpticalSizeOf(density.data(), grid, 3.0);
    EXPECT_DOUBLE_EQ(size.thickness, 3.0 * 0.5 * grid.Length(axis)) << axis;
    EXPECT_DOUBLE_EQ(size.meanFreePath, 1.0 / 1.5) << axis; // of what is filled
  }
}

TEST(OpticalSize, OfVacuumIsNothing)
{
  Grid grid;
  grid.size = { 2, 2, 2 };
  const std::vector<float> vacuum(grid.VoxelCount(), 0.0f);
  EXPECT_EQ(OpticalSizeOf(vacuum.data(), grid, 1.0).thickness, 0.0);
  EXPECT_EQ(OpticalSizeOf(vacuum.data(), grid, 1.0).meanFreePath, 0.0);
}
