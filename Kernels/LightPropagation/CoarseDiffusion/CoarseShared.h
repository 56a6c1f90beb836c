// Shared by C++ and the kernels of diffusion on cells of several voxels.
#pragma once

#include "LightPropagation/Diffusion/DiffusionShared.h"

SHARED_BEGIN
/// Cells of voxels, and where a channel's voxels begin.
typedef struct
{
  int size[3]; ///< voxels
  float spacing[3];
  int periodic[3];
  int halvings[3];   ///< of voxels into cells along each axis: 2^halvings voxels an edge, the last cell perhaps fewer
  int first, firstT; ///< where the channel begins: in all arrays but sigma_t, in that
  MultigridLevel cells; ///< how arrays over cells lie in memory
} CoarseCells;
SHARED_END
