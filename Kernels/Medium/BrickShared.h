// Shared by C++ and the kernels that process bricks of voxels.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  BrickBits = 3,    ///< number of low bits of a voxel's index along an axis that are its position within the brick
  BrickEdge = 8,    ///< voxels per edge of a brick, as in OpenVDB's leaf nodes
  BrickVoxels = 512 ///< voxels per brick
};
SHARED_END
