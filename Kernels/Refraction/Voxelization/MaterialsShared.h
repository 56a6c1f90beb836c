// Shared by C++ and the kernels of Materials.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Voxels of a slab: runs of `length` of the box's, the first from `first` on, each `stride` further.
typedef struct
{
  float4 corner, spacing;      ///< length: the whole grid's lower corner, edges of a voxel
  ulong first, length, stride; ///< in the box of the grid that is voxelised
  int nx, ny;                  ///< voxels of the box
  int x0, y0, z0;              ///< voxel of the whole grid with which it begins
  float samples;               ///< of a voxel
} MaterialSlab;

typedef struct
{
  float4 absorption, scattering; ///< red, green, blue, 1/length
  float n;
  float indexNoise;      ///< by how much n is perturbed, +-
  float scatteringNoise; ///< the same for sigma_s, relative
  float frequency;       ///< 1 / size of the noise's features, 1/length
  uint seed;
  float g; ///< mean cosine of the phase function
} MaterialInfo;
SHARED_END
