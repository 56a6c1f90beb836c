// Shared by C++ and the kernels that read a light pyramid.
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

/// Fields of the gains, one cell for 2 x 2 x 2 cells of the finer level.
enum
{
  GainField = 0,    ///< fraction of the details that is kept
  RemovedField = 1, ///< squared details that are removed, minus their noise
  KeptField = 2,    ///< squared noise that is kept
  ErrorField = 3,   ///< squared error of the finer level's cells
  GainFields = 4
};

enum
{
  BesideResults = 2 ///< fields of a level of the result after the smoothed quantities: source level, squared error
};
SHARED_END
