// Size of a grid, shared by C++ and the kernels that read the squared refractive index.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// Number of voxels of a grid along x, y, z.
typedef struct
{
  int size[3];
} IndexGrid;
SHARED_END
