// Shared by C++ and the kernels that read several levels of a light pyramid.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  LevelsAtMost = 8 ///< largest number of levels above the grid
};

/// Position and layout of the levels in memory.
typedef struct
{
  int4 size[LevelsAtMost + 1];  ///< layout as in LightRows.cl
  int4 first[LevelsAtMost + 1]; ///< index, in the level's voxel grid, of the first voxel of the block; 0 without blocks
  ulong offset[LevelsAtMost + 1];
} PyramidLevels;
SHARED_END
