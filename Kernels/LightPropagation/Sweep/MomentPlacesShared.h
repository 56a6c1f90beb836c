// Shared by C++ and kernels: memory layout of angular moments.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  MomentGroup = 16 ///< voxels of a row whose moments are stored together
};

/// An array with angular moments begins with the first function, the fluence, stored like any other array:
/// [channel][stride]. The other functions follow in groups of voxels, [z][y][channel][group][function][MomentGroup], so
/// that a sweep along any axis reads contiguous memory. Beams come last, [beam][channel][stride].
typedef struct
{
  ulong second; ///< index of the second function's first value
  ulong beams;
  int sizeX, groups; ///< voxels and groups of a row
  int channels;
  int functions; ///< number of angular functions, including the first
} MomentPlaces;

/// Index of a voxel's value of a function from the second on. `line` is z * sizeY + y, as ulong.
#define MOMENT_PLACE(places, function, channel, line, x)                                                           \
  ((places).second +                                                                                               \
    ((((line) * (places).channels + (channel)) * (places).groups + (x) / MomentGroup) * ((places).functions - 1) + \
      (function)-1) *                                                                                              \
      MomentGroup +                                                                                                \
    (x) % MomentGroup)
SHARED_END
