// Shared by C++ and the kernels of discrete ordinates.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  OrdinateBlock = 8 ///< number of consecutive voxels that scatter together, or together have no medium
};
/// Geometry of a lamp and of the grid, for LampScattering.cl.
typedef struct
{
  int size[3];
  int parallel; ///< 1: parallel rays; 0: the lamp has a position
  float spacing[3];
  /// Position of the lamp relative to the lowest corner of the box; for parallel rays their unit direction.
  float place[3];
  float meanCosine; ///< mean cosine of the phase function
  float perVolume;  ///< 1 / volume of a voxel, 1 / length^3
} LampInRays;
/// Part of the grid that a launch of sweep_upwind sweeps: all voxels, the voxels of a box, or the voxels downwind of
/// the box.
enum
{
  SweepsAll = 0,
  SweepsBox = 1,
  SweepsBeyondBox = 2
};
/// Grid, and the range of layers along z that a launch of sweep_upwind processes.
typedef struct
{
  int size[3];
  int first[3], last[3]; ///< lowest and highest voxel of the box; of the whole grid if part is SweepsAll
  int part;              ///< SweepsAll, SweepsBox or SweepsBeyondBox
  int begin, end; ///< range of layers of that part, counted in the order in which the directions of a group cross them
  int skips;      ///< 1: sweep_upwind leaves only sums over directions in blocks without medium (UpwindSweep.cl)
  float perArea[3]; ///< 1 / area of a voxel's face normal to each axis for the sums of the net flux; 0: no net flux
  /// number of voxels from the radiance of one group of directions to that of the next (OrdinateStride)
  ulong stride;
  ulong firstT, firstSource; ///< index of the channel's first value in the extinction, and in an isotropic source
  int ofMean;                ///< what sums over directions hold, see SweptSums::ofMean
  float thin;                ///< extinction up to which a sweep by diamond differences has mean chords, 1/length
} SweptLayers;

/// Range of voxels that a launch of a scattering kernel processes.
typedef struct
{
  ulong voxels; ///< number of voxels of the grid
  ulong stride; ///< number of voxels from the radiance of one group of directions to that of the next (OrdinateStride)
  ulong begin;  ///< first voxel of the launch
  int width, height;     ///< number of voxels of the grid along x and y
  int first[2], last[2]; ///< range of the voxels with light along x and y; blocks of voxels outside it are skipped
  int skips;             ///< 1: blocks of voxels that do not scatter are skipped
  int hasSums;           ///< 1: of blocks without medium, the radiance holds sums over directions (UpwindSweep.cl)
} ScatteringVoxels;
SHARED_END
