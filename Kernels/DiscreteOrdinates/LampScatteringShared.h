// Shared by C++ and the kernel of LampScattering.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Geometry of a lamp and of the box.
typedef struct
{
  int size[3];
  int parallel; ///< 0: the lamp has a position
  float spacing[3];
  float place[3];   ///< position from the corner of the box; of parallel rays the unit direction
  float meanCosine; ///< mean cosine of scattering to reproduce
  float perVolume;  ///< 1 / length^3
} LampInRays;
SHARED_END
