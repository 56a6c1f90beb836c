// Shared by C++ and the kernels that sum over voxels.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  CollectChunk = 4096 ///< number of voxels that a work-group sums in float; the host adds the sums of groups in double
};
SHARED_END
