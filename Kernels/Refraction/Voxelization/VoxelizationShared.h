// Structures shared by C++ and the kernels that voxelise meshes.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Voxels of a slab: runs of `length` consecutive voxels of a box. The first run begins at voxel `first`, each later
/// run `stride` voxels after the one before.
typedef struct
{
  float4 corner, spacing; ///< lower corner of the grid, and edges of a voxel, in units of length
  /// Numbers of voxels of the box: before the first voxel of the slab, in a run, and from the beginning of a run to
  /// that of the next.
  ulong first, length, stride;
  int nx, ny;     ///< number of voxels of the box along x and y
  int x0, y0, z0; ///< first voxel of the box in the grid
  float samples;  ///< count of a voxel that is entirely inside: samples^3 UnitsOfSample
} MaterialSlab;

typedef struct
{
  float4 absorption, scattering; ///< coefficients of red, green and blue, 1/length
  float n;                       ///< refractive index
  float indexNoise;              ///< amplitude of the noise added to n
  float scatteringNoise;         ///< amplitude of the noise by which sigma_s varies, relative to sigma_s
  float frequency;               ///< 1 / size of the noise's features, 1/length
  uint seed;                     ///< seed of the noise
  float g;                       ///< mean cosine of the phase function
} MaterialInfo;

/// Rows of sample columns in a buffer. They cover a slab, the voxels that are processed at a time.
typedef struct
{
  int4 voxels;    ///< number of voxels of the slab along x, y, z
  int words;      ///< number of 32-bit words per column
  int columns;    ///< number of columns per row
  int firstRow;   ///< index of the first row of columns in the buffer
  int firstVoxel; ///< index of the slab's first row of voxels, along the `up` axis of the columns
  int several;    ///< 1: there are several meshes, so that samples may belong to later meshes
} SampleRows;

/// Parameters of the kernel count_samples.
typedef struct
{
  int voxels;        ///< number of voxels per column
  int columns, rows; ///< numbers of columns of voxels per row, and of rows
  int words;         ///< number of 32-bit words per column of samples
  int skipped;       ///< number of rows of samples in the buffer that precede those of the slab's voxels
  int claims;        ///< 1: samples that belong to later meshes are not counted
  int units;         ///< number that is added to a voxel's count for each sample: 1 or UnitsOfSample
  /// Distance, in the array of counts, between neighbouring voxels of a column, between columns of a row, and between
  /// rows.
  int along, across, up;
} SampleCounts;
SHARED_END
