// Shared by C++ and the kernels that read several levels of a light pyramid.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  LevelsAtMost = 8 ///< of a pyramid, above the grid
};

/// Where the levels lie.
typedef struct
{
  int4 size[LevelsAtMost + 1];  ///< as in LightRows.cl
  int4 first[LevelsAtMost + 1]; ///< voxel of the level's grid that the first voxel looked at is; 0 but of a block
  ulong offset[LevelsAtMost + 1];
} PyramidLevels;
SHARED_END
