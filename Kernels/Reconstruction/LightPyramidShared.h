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
  /// First voxel of the block, counted from the first voxel that the level covers: its position in the domain for
  /// levels that cover the domain, 0 for levels that cover only the block.
  int4 first[LevelsAtMost + 1];
  ulong offset[LevelsAtMost + 1]; ///< offset of each level in the buffer, in floats
} PyramidLevels;

/// How LevelReconstruction.cl chooses the level from which a voxel's light is taken.
enum LevelEstimator
{
  ByPublished,
  ByConstantRadius, ///< the highest level in all voxels
  ByNearestPhotons
};

/// Fields of the gains, per cell of a level. The gain is the fraction of the details that is kept in the cell's 2 x 2 x
/// 2 children, the cells of the next finer level; details are the finer level minus the interpolation of this level.
/// The other fields are squared errors.
enum
{
  GainField = 0,    ///< fraction of the details that is kept, Eq. (102) of numerics.md
  RemovedField = 1, ///< squared light that is removed: (1 - gain)^2 (d^2 - noise), d the detail, Eq. (104)
  KeptField = 2,    ///< squared noise that is kept: gain^2 noise, Eq. (104)
  ErrorField = 3,   ///< squared error of the cells of the next finer level
  GainFields = 4
};

enum
{
  /// Number of fields of a result after the smoothed quantities. They are the source level (the pyramid level from
  /// which the light is taken) and the squared error.
  BesideResults = 2
};
SHARED_END
