// What C++ and OpenCL C share, a struct or a constant, is written once, in a header that both compile: its name ends in
// Shared.h and it includes this one. Members are int, float, uint, ulong, int2, int4 and float4, which have the same
// size and alignment on both sides; constants are enumerators. All stands between SHARED_BEGIN and SHARED_END, which
// put it into C++'s namespace.
#pragma once

#ifdef __OPENCL_C_VERSION__
#define SHARED_BEGIN
#define SHARED_END
#else
#define SHARED_BEGIN \
  namespace tyndall  \
  {
#define SHARED_END }

#include <Device/OpenCL.h> // in these brackets: EmbedKernels.cmake leaves it where it is

namespace tyndall
{
using uint = cl_uint;
using ulong = cl_ulong;
using int2 = cl_int2;
using int4 = cl_int4;
using float4 = cl_float4;
static_assert(sizeof(int) == sizeof(cl_int) && sizeof(float) == sizeof(cl_float), "OpenCL's int and float are ours");
}
#endif
