// Shared by C++ and the kernel of LampScattering.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// A lamp whose uncollided light is known, and the box.
typedef struct
{
  int size[3];
  int parallel; ///< else it is at a place
  float spacing[3];
  float place[3];   ///< of the lamp, from the box's corner; of parallel rays their direction, a unit vector
  float meanCosine; ///< that scattering is to have
  float perVolume;  ///< 1 / length^3
} LampInRays;
SHARED_END
