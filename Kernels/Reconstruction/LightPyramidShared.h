// Shared by C++ and the kernels that read several levels of a light pyramid.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Where the levels lie.
typedef struct
{
  int4 size[9]; ///< as in LightRows.cl
  ulong offset[9];
} PyramidLevels;
SHARED_END
