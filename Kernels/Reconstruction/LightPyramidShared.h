// Constants and structures shared by C++ and the kernels that read a light pyramid.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  LevelsAtMost = 8 ///< maximum number of levels of a pyramid above the grid
};

/// Position and layout of a pyramid's levels in memory.
typedef struct
{
  int4 size[LevelsAtMost + 1]; ///< layout of each level as in LightRows.cl: cells along x, y, z, and floats per row
  /// Index of the block's first voxel in the level's voxel grid; 0 in levels of the block itself.
  int4 first[LevelsAtMost + 1];
  ulong offset[LevelsAtMost + 1]; ///< offset of each level in the buffer, in floats
} PyramidLevels;

/// Fields of the gains, which are stored per cell of a level and apply to the 2 x 2 x 2 cells of the next finer
/// level.
enum
{
  GainField = 0,    ///< fraction of the details that is kept, Eq. (102) of numerics.md
  RemovedField = 1, ///< removed light squared: (1 - gain)^2 (total - noise), Eq. (104)
  KeptField = 2,    ///< squared noise that is kept: gain^2 noise, Eq. (104)
  ErrorField = 3,   ///< squared error of the cells of the next finer level
  GainFields = 4
};

enum
{
  BesideResults = 2 ///< number of fields of a result after the smoothed quantities: source level, squared error
};
SHARED_END
