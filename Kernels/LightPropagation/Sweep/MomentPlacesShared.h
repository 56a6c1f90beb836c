// Shared by C++ and kernels: where angular moments lie in an array.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Arrays with angular moments begin with the first function, which is fluence, as all others do: [channel][stride].
/// The other functions follow row by row, [z][y][channel][function][row], so that what a sweep needs of a row lies
/// together, then beams, [beam][channel][stride].
typedef struct
{
  ulong second; ///< where the second function begins
  ulong beams;
  int sizeX, row; ///< voxels and floats of a row
  int channels;
  int functions; ///< with the first
} MomentPlaces;

/// Of a voxel (line: z size y + y, as ulong) in a function from the second on.
#define MOMENT_PLACE(places, function, channel, line, x)                                                             \
  ((places).second +                                                                                                 \
    (((line) * (places).channels + (channel)) * ((places).functions - 1) + ((function)-1)) * (places).row + (x))
SHARED_END
