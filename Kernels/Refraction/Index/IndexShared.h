// Shared by C++ and the kernels that read the squared refractive index.
#pragma once

#include "Device/SharedTypes.h"

#ifndef __OPENCL_C_VERSION__
namespace tyndall
{
#endif
/// Voxels of a grid along x, y, z.
typedef struct
{
  int size[3];
} IndexGrid;
#ifndef __OPENCL_C_VERSION__
}
#endif
