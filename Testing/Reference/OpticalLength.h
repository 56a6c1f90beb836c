#pragma once

#include <array>

/// Mean free paths on the straight way between two points of a grid, voxel by voxel.
/// @param size        voxels per axis; @param spacing  their edges, length
/// @param extinction  1/length, x fastest
/// @param from, to    in voxels, from the grid's lower corner
double OpticalLength(const std::array<int, 3>& size, const std::array<double, 3>& spacing, const float* extinction,
  const std::array<double, 3>& from, const std::array<double, 3>& to);
