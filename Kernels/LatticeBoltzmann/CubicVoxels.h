#pragma once

#include "Medium/Grid.h"

#include <algorithm>

namespace tyndall
{
/// Whether voxels are cubes to 0.1%, as the lattice requires.
inline bool HasCubicVoxels(const Grid& grid)
{
  const auto [least, most] = std::minmax_element(grid.spacing.begin(), grid.spacing.end());
  return *most <= 1.001 * *least;
}
}
