// Shared by C++ and the kernels that voxelise meshes.
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

/// Columns of samples of a slab in a buffer, and the slab's voxels.
typedef struct
{
  int4 voxels;    ///< voxels of the slab along x, y, z
  int words;      ///< 32-bit words per column
  int columns;    ///< columns per row
  int firstRow;   ///< first row of columns in the buffer
  int firstVoxel; ///< first row of the slab's voxels, along the `up` axis of the columns
  int several;    ///< 1: there are several meshes, so that samples may belong to a later one
} SampleRows;

/// Parameters of count_samples.
typedef struct
{
  int voxels;            ///< voxels per column
  int columns, rows;     ///< columns of voxels
  int words;             ///< 32-bit words per column of samples
  int skipped;           ///< rows of samples before those of the first voxels
  int claims;            ///< 1: samples of later meshes are taken into account
  int units;             ///< factor of the counts
  int along, across, up; ///< strides of the counts from voxel to voxel
} SampleCounts;
SHARED_END
