// Shared by C++ and the kernels that sum up over voxels.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  CollectChunk = 4096 ///< voxels that a work-group sums up in float before the host adds the sums in double
};
SHARED_END
