// Shared by C++ and the kernels of Materials.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Voxels of a slab: runs of `length` consecutive voxels of the box; the first run starts at voxel `first`, the next
/// ones at intervals of `stride`.
typedef struct
{
  float4 corner, spacing;      ///< length: lower corner of the whole grid, edges of a voxel
  ulong first, length, stride; ///< voxel indices in the box of the grid that is voxelised
  int nx, ny;                  ///< voxels of the box along x and y
  int x0, y0, z0;              ///< first voxel of the box in the whole grid
  float samples;               ///< number of samples in a voxel
} MaterialSlab;

typedef struct
{
  float4 absorption, scattering; ///< red, green, blue, 1/length
  float n;
  float indexNoise;      ///< amplitude of the perturbation of n
  float scatteringNoise; ///< amplitude of the relative perturbation of sigma_s
  float frequency;       ///< 1 / size of the noise's features, 1/length
  uint seed;
  float g; ///< mean cosine of the phase function
} MaterialInfo;
SHARED_END
