// Memory layout of angular moments, shared by C++ and OpenCL kernels.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  MomentGroup = 16 ///< number of neighbouring voxels of a row along x whose moments are adjacent in memory
};

/// Memory layout of an array with the angular moments of each voxel. The moment of the first angular function, the
/// fluence, is stored like any other array: [channel][voxel]. The moments of the other functions follow, for groups of
/// MomentGroup neighbouring voxels along x: [z][y][channel][group][function][voxel of the group], so that a sweep along
/// any axis reads contiguous memory. The values of beams (sources with their own angular distribution) are last,
/// [beam][channel][voxel].
typedef struct
{
  ulong second; ///< index of the first value of the second angular function
  ulong beams;
  int sizeX, groups; ///< number of voxels, and of groups of MomentGroup voxels, along x
  int channels;
  int functions; ///< number of angular functions, including the first (fluence)
} MomentPlaces;

/// Index of the value of angular function `function` >= 1 in the voxel at `x` of a row along x. `line` is the index of
/// that row, z * sizeY + y, as ulong.
#define MOMENT_PLACE(places, function, channel, line, x)                                                           \
  ((places).second +                                                                                               \
    ((((line) * (places).channels + (channel)) * (places).groups + (x) / MomentGroup) * ((places).functions - 1) + \
      (function)-1) *                                                                                              \
      MomentGroup +                                                                                                \
    (x) % MomentGroup)
SHARED_END
