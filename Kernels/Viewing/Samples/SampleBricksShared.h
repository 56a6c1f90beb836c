// Shared by C++ and the kernels that write or read samples in bricks.
#pragma once

#include "Medium/BrickShared.h"

SHARED_BEGIN
enum
{
  SampleEdge = BrickEdge + 1 ///< samples along an edge of a brick of cells
};
SHARED_END
