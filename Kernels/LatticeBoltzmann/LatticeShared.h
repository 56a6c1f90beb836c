// Shared by C++ and the kernels of LatticeStep.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// A lattice in memory: voxels with one more round them, rows of `row` values, the first voxel at 1.
typedef struct
{
  int size[3]; ///< voxels
  int row, layer;
  int offset[18];  ///< from a voxel to the one that a direction leads to
  float albedo[6]; ///< part of what leaves through -x, +x, ... +z that comes back
  ulong stride;    ///< of densities, from direction to direction
} LatticeInfo;
SHARED_END
