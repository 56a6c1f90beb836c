#include "Medium/OpticalSize.h"

#include "Device/HostThreads.h"
#include "Medium/VoxelSums.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Largest sum of the density along any row of voxels parallel to an axis.
double LargestRow(const float* density, const Grid& grid, int axis)
{
  const PlaneAxes plane = AcrossAxis(axis);
  const std::array<std::size_t, 3> stride = grid.Strides();
  const std::size_t rows = static_cast<std::size_t>(grid.size[plane.v]);
  const std::size_t width = static_cast<std::size_t>(grid.size[plane.u]);
  std::vector<double> largest(rows, 0.0);
  InThreads(
    rows, 1 + 65536 / (width * static_cast<std::size_t>(grid.size[axis])), [&](std::size_t begin, std::size_t end) {
      std::vector<double> sums(width);
      for (std::size_t v = begin; v < end; ++v)
      {
        sums.assign(width, 0.0);
        for (int along = 0; along < grid.size[axis]; ++along)
        {
          const float* const row = density + along * stride[axis] + v * stride[plane.v];
          for (std::size_t u = 0; u < width; ++u)
          {
            sums[u] += static_cast<double>(row[u * stride[plane.u]]);
          }
        }
        largest[v] = *std::max_element(sums.begin(), sums.end());
      }
    });
  return *std::max_element(largest.begin(), largest.end());
}

std::size_t RowsAlong(const Grid& grid, int axis)
{
  const PlaneAxes plane = AcrossAxis(axis);
  return static_cast<std::size_t>(grid.size[plane.u]) * static_cast<std::size_t>(grid.size[plane.v]);
}
}

OpticalSize OpticalSizeOf(const float* density, const Grid& grid, double extinction)
{
  OpticalSize size;
  for (int axis = 0; axis < 3; ++axis)
  {
    size.thickness = std::max(size.thickness, LargestRow(density, grid, axis) * grid.spacing[axis] * extinction);
  }
  const double filled = SumOverVoxels(grid, [&](std::size_t i) { return density[i] > 0.0f ? 1.0 : 0.0; });
  const double total = SumOverVoxels(grid, [&](std::size_t i) { return static_cast<double>(density[i]); }) * extinction;
  size.meanFreePath = total > 0.0 ? filled / total : 0.0;
  return size;
}

std::vector<double> OpticalSumsOf(const float* density, const VoxelBox& box, const Grid& whole)
{
  std::vector<double> sums(RowsAlong(whole, 0) + RowsAlong(whole, 1) + RowsAlong(whole, 2) + 2, 0.0);
  double* const along[3] = { sums.data(), sums.data() + RowsAlong(whole, 0),
    sums.data() + RowsAlong(whole, 0) + RowsAlong(whole, 1) };
  double& total = sums[sums.size() - 2];
  double& filled = sums.back();
  for (int k = 0; k < box.size[2]; ++k)
  {
    const std::size_t z = static_cast<std::size_t>(box.first[2] + k);
    for (int j = 0; j < box.size[1]; ++j)
    {
      const std::size_t y = static_cast<std::size_t>(box.first[1] + j);
      for (int i = 0; i < box.size[0]; ++i)
      {
        const std::size_t x = static_cast<std::size_t>(box.first[0] + i);
        const double value = *density++;
        along[0][z * whole.size[1] + y] += value;
        along[1][z * whole.size[0] + x] += value;
        along[2][y * whole.size[0] + x] += value;
        total += value;
        filled += value > 0.0 ? 1.0 : 0.0;
      }
    }
  }
  return sums;
}

OpticalSize OpticalSizeOf(const std::vector<double>& sums, const Grid& whole, double extinction)
{
  OpticalSize size;
  auto row = sums.begin();
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto end = row + static_cast<std::ptrdiff_t>(RowsAlong(whole, axis));
    size.thickness = std::max(size.thickness, *std::max_element(row, end) * whole.spacing[axis] * extinction);
    row = end;
  }
  const double total = row[0] * extinction, filled = row[1];
  size.meanFreePath = total > 0.0 ? filled / total : 0.0;
  return size;
}
}
