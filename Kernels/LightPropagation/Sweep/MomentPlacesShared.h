// Shared by C++ and kernels: where angular moments lie in an array.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  MomentGroup = 16 ///< voxels of a row whose moments lie together
};

/// Arrays with angular moments begin with the first function, which is fluence, as all others do: [channel][stride].
/// The other functions follow by groups of voxels, [z][y][channel][group][function][MomentGroup], so that what a sweep
/// needs of them is read in one go along every axis, then beams, [beam][channel][stride].
typedef struct
{
  ulong second; ///< where the second function begins
  ulong beams;
  int sizeX, groups; ///< of a row
  int channels;
  int functions; ///< with the first
} MomentPlaces;

/// Of a voxel (line: z size y + y, as ulong) in a function from the second on.
#define MOMENT_PLACE(places, function, channel, line, x)                                                           \
  ((places).second +                                                                                               \
    ((((line) * (places).channels + (channel)) * (places).groups + (x) / MomentGroup) * ((places).functions - 1) + \
      (function)-1) *                                                                                              \
      MomentGroup +                                                                                                \
    (x) % MomentGroup)
SHARED_END
