// Shared by C++ and the kernels that go by bricks of voxels.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  BrickBits = 3,    ///< of a voxel's number along an axis, those within its brick
  BrickEdge = 8,    ///< voxels per edge of a brick; the same as of OpenVDB's leaves
  BrickVoxels = 512 ///< of a brick
};
SHARED_END
