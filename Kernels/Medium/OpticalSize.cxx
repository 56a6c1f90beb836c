#include "Medium/OpticalSize.h"

#include "Device/HostThreads.h"
#include "Medium/VoxelSums.h"

#include <algorithm>
#include <vector>

namespace tyndall
{
namespace
{
/// The largest sum of a row of voxels along an axis.
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
}
