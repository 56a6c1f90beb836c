#include "Distribution/BoxExchange.h"
#include "Medium/OpticalSize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
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

TEST(OpticalSize, OfBoxesThatMakeUpTheGridIsThatOfTheGrid)
{
  Grid grid;
  grid.size = { 5, 4, 3 };
  grid.spacing = { 0.5, 1.0, 2.0 };
  std::vector<float> density;
  for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
  {
    density.push_back(static_cast<float>(i * 7 % 11) * (i % 3 == 0 ? 0.0f : 1.0f));
  }
  const BlockPartition partition = BlockPartition::Even(grid, 4);
  std::vector<double> sums;
  for (const VoxelBox& box : partition.blocks)
  {
    const std::vector<float> part = PartOf(density, { { 0, 0, 0 }, grid.size }, box, 1);
    const std::vector<double> ofBox = OpticalSumsOf(part.data(), box, grid);
    sums.resize(ofBox.size(), 0.0);
    std::transform(ofBox.begin(), ofBox.end(), sums.begin(), sums.begin(), std::plus<double>());
  }
  const OpticalSize size = OpticalSizeOf(sums, grid, 3.0), whole = OpticalSizeOf(density.data(), grid, 3.0);
  EXPECT_NEAR(size.thickness, whole.thickness, 1e-12 * whole.thickness);
  EXPECT_NEAR(size.meanFreePath, whole.meanFreePath, 1e-12 * whole.meanFreePath);
}
