// Shared by C++ and the kernels of diffusion on cells of several voxels.
#pragma once

#include "LightPropagation/Diffusion/DiffusionShared.h"

SHARED_BEGIN
/// The voxels of a rank's block, the cells of the whole grid, and the offsets of a channel's voxels.
typedef struct
{
  int size[3];               ///< voxels of the block
  int origin[3];             ///< its first voxel in the whole grid
  int held[3];               ///< voxels of the block with its ghost voxels
  int lead[3];               ///< number of ghost voxels before the block
  int wraps[3];              ///< 1: periodic axes that the block spans from end to end
  int first, firstT;         ///< offset of the channel: in arrays of the block but sigma_t; in sigma_t
  int heldFirst, heldFirstT; ///< the same in arrays with ghost voxels
  float spacing[3];
  int linear;           ///< 1: light varies linearly across voxels; 0: it is constant in each
  int periodic[3];      ///< of the whole grid
  int halvings[3];      ///< halvings along each axis: a cell has 2^halvings voxels per edge, the last one perhaps fewer
  MultigridLevel cells; ///< memory layout of arrays over cells of the whole grid
} CoarseCells;
SHARED_END
