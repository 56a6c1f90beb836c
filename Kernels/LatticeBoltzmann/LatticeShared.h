// Shared by C++ and the kernels of LatticeStep.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
typedef struct
{
  int size[3];
  int periodic[3];
  float incoming[6]; ///< W / length^2: fluence of the diffuse light outside -x, +x, ... +z
  float albedo[6];   ///< part of what leaves that comes back
  ulong stride;      ///< of densities, from direction to direction
} LatticeInfo;
SHARED_END
