#pragma once

#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <vector>

namespace tyndall
{
/// Optical thickness and mean free path of a medium.
struct OpticalSize
{
  double thickness = 0.0; ///< largest optical thickness, from face to face, of any row of voxels along x, y or z
  /// 1 / (mean extinction of the voxels that are not empty), in units of length; 0 if all are empty
  double meanFreePath = 0.0;
};

/// Optical size of a medium with extinction proportional to a density.
/// @param density  one value per voxel, x fastest, not negative
/// @param extinction  coefficient at density 1, 1/length, not negative
OpticalSize OpticalSizeOf(const float* density, const Grid& grid, double extinction);

/// Sums from which OpticalSizeOf() is computed, over a box of the grid: the density summed along each row in x, y and
/// z, the total, and the number of voxels that are not empty. For disjoint boxes that cover the grid, they add up to
/// the sums of the grid.
/// @param density  one value per voxel of the box, x fastest, not negative
std::vector<double> OpticalSumsOf(const float* density, const VoxelBox& box, const Grid& whole);
/// Optical size of a medium, from sums over its boxes.
/// @param sums  results of OpticalSumsOf(), added over the boxes
/// @param extinction  coefficient at density 1, 1/length, not negative
OpticalSize OpticalSizeOf(const std::vector<double>& sums, const Grid& whole, double extinction);
}
