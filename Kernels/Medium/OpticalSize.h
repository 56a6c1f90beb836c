#pragma once

#include "Medium/Grid.h"

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
}
