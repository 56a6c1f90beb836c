#pragma once

#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <vector>

namespace tyndall
{
/// How large a medium is to light.
struct OpticalSize
{
  double thickness = 0.0; ///< the largest optical thickness of a row of voxels along x, y or z, from face to face
  double meanFreePath =
    0.0; ///< 1 / mean extinction of the voxels that are not empty, in the dataset's unit; 0: all are
};

/// @param density     of each voxel, x fastest, not negative
/// @param extinction  coefficient at density 1, 1/length, not negative
OpticalSize OpticalSizeOf(const float* density, const Grid& grid, double extinction);

/// What there is of a medium in a box of its grid, such that boxes that together have each voxel once add up to the
/// whole: sums of each row along x, y and z, of all voxels, and how many are filled.
/// @param density  of each voxel of the box, x fastest, not negative
std::vector<double> OpticalSumsOf(const float* density, const VoxelBox& box, const Grid& whole);
/// @param sums  OpticalSumsOf, added up over the boxes
OpticalSize OpticalSizeOf(const std::vector<double>& sums, const Grid& whole, double extinction);
}
