#pragma once

#include "Device/HostThreads.h"
#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Sums of a quantity over the lines of voxels along each axis, by axis and position on the other two axes, the lower
/// one fastest.
using LineSums = std::array<std::vector<double>, 3>;

/// @param value  value(voxel); called from several threads
template <class Value>
LineSums SumAlongLines(const Grid& grid, const Value& value)
{
  const std::array<int, 3>& n = grid.size;
  LineSums lines;
  for (int axis = 0; axis < 3; ++axis)
  {
    lines[axis].assign(n[axis] > 0 ? grid.VoxelCount() / static_cast<std::size_t>(n[axis]) : 0, 0.0);
  }
  const auto addRows = [&](int y, int z, double* alongX, double* alongOther) {
    std::size_t i = grid.IndexOf({ 0, y, z });
    for (int x = 0; x < n[0]; ++x, ++i)
    {
      const double here = value(i);
      *alongX += here;
      alongOther[x] += here;
    }
  };
  InThreads(n[2], 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z)
    {
      for (int y = 0; y < n[1]; ++y)
      {
        addRows(y, static_cast<int>(z), &lines[0][z * n[1] + y], lines[1].data() + z * n[0]);
      }
    }
  });
  InThreads(n[1], 1, [&](std::size_t begin, std::size_t end) { // lines along z end in other planes
    for (std::size_t y = begin; y < end; ++y)
    {
      for (int z = 0; z < n[2]; ++z)
      {
        double unused = 0.0;
        addRows(static_cast<int>(y), z, &unused, lines[2].data() + y * n[0]);
      }
    }
  });
  return lines;
}

/// Optical thickness of lines of voxels along each axis. Light stays longest in the thickest lines, but leaks into
/// their neighbours. The estimate therefore averages the thickest line (weight 1/3) and all lines, each weighted by its
/// thickness (2/3). With it, the predicted number of scattering orders is within two thirds of the actual one for
/// log-normal media of tau 1 to 12 and albedo 0.8 to 0.98; the thickest line alone overestimates it up to three times
/// (numerics.md, Eq. (86a)).
struct ThickLines
{
  ThickLines() = default; ///< vacuum
  /// @param sigma_t  sums of the extinction, 1/length
  ThickLines(const Grid& grid, const LineSums& sigma_t);

  std::array<double, 3> along = {};
  bool uneven = false; ///< the thickest line is much thicker than the mean
};
}
