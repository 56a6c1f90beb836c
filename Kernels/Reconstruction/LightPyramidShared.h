// Shared by C++ and the kernels that read several levels of a light pyramid.
#pragma once

#include "Device/SharedTypes.h"

#ifndef __OPENCL_C_VERSION__
namespace tyndall
{
#endif
/// Where the levels lie.
typedef struct
{
  int4 size[9]; ///< as in LightRows.cl
  ulong offset[9];
} PyramidLevels;
#ifndef __OPENCL_C_VERSION__
}
#endif
