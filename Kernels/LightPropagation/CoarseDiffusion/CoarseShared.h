// Shared by C++ and the kernels of coarse-mesh DSA.
#pragma once

#include "LightPropagation/Diffusion/DiffusionShared.h"

SHARED_BEGIN
/// Geometry of the voxels of a rank's block and of the cells of the whole grid, and the offsets of one channel in
/// arrays.
typedef struct
{
  int size[3];   ///< voxels of the block
  int origin[3]; ///< first voxel of the block in the whole grid
  int held[3];   ///< voxels of the block with its ghost voxels
  int lead[3];   ///< number of ghost voxels below the block along each axis
  int wraps[3];  ///< by axis, 1: the axis is periodic, and the block spans it from end to end
  /// offset of the channel in arrays of the block; `firstT`: in sigma_t, which all channels may share
  int first, firstT;
  /// Offset of the channel in arrays with ghost voxels; `heldFirstT`: in sigma_t
  int heldFirst, heldFirstT;
  float spacing[3];
  int linear;           ///< 1: light varies linearly across voxels; 0: it is constant in each
  int periodic[3];      ///< by axis, 1: the axis of the whole grid is periodic
  int halvings[3];      ///< a cell has 2^halvings voxels along the axis; the last cell may have fewer
  MultigridLevel cells; ///< memory layout of arrays over cells of the whole grid
} CoarseCells;
SHARED_END
