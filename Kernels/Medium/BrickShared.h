// Shared by C++ and the kernels that process bricks of voxels.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  BrickBits = 3,    ///< bits of a voxel's index along an axis that give its place within the brick
  BrickEdge = 8,    ///< voxels per edge of a brick; the same as of OpenVDB's leaves
  BrickVoxels = 512 ///< voxels per brick
};
SHARED_END
