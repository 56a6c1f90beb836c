// Shared by C++ and the kernels of diffusion on cells of several voxels.
#pragma once

#include "LightPropagation/Diffusion/DiffusionShared.h"

SHARED_BEGIN
/// Cells of voxels, and the offsets of a channel's voxels.
typedef struct
{
  int size[3]; ///< voxels
  float spacing[3];
  int periodic[3];
  int halvings[3];      ///< halvings along each axis: a cell has 2^halvings voxels per edge, the last one perhaps fewer
  int first, firstT;    ///< offset of the channel: in all arrays but sigma_t; in sigma_t
  MultigridLevel cells; ///< memory layout of arrays over cells
} CoarseCells;
SHARED_END
