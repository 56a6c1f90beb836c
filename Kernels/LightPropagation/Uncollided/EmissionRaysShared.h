// Shared by C++ and the kernels of EmissionRays.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// A medium and the box of what shines in it.
typedef struct
{
  int size[3];
  float spacing[3];
  int sourceFirst[3], sourceSize[3]; ///< the box of what shines
  int fewest;                        ///< rays of a voxel to it, at first; a power of two, at least 32
  float uneven;                      ///< difference of two halves of them, to their sum, that will do
} EmissionInfo;
SHARED_END
