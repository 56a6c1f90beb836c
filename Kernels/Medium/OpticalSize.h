#pragma once

#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <vector>

namespace tyndall
{
/// Optical size of a medium.
struct OpticalSize
{
  double thickness = 0.0; ///< largest optical thickness, from face to face, of any row of voxels along x, y or z
  double meanFreePath =
    0.0; ///< 1 / mean extinction of the voxels that are not empty, in the dataset's unit; 0: all are
};

/// @param density  one value per voxel, x fastest, not negative
/// @param extinction  coefficient at density 1, 1/length, not negative
OpticalSize OpticalSizeOf(const float* density, const Grid& grid, double extinction);

/// Partial sums for OpticalSizeOf over a box of the grid: the density summed along each row in x, y and z, the total,
/// and the number of voxels that are not empty. The sums of disjoint boxes that cover the grid add up to those of the
/// grid.
/// @param density  one value per voxel of the box, x fastest, not negative
std::vector<double> OpticalSumsOf(const float* density, const VoxelBox& box, const Grid& whole);
/// @param sums  OpticalSumsOf, summed over the boxes
OpticalSize OpticalSizeOf(const std::vector<double>& sums, const Grid& whole, double extinction);
}
