// Types for structures and constants that C++ and OpenCL C share. Such structures are defined once, in a header that
// both languages compile; its name ends in Shared.h, and it includes this header. Members are int, float, uint, ulong,
// int2, int4 and float4, which have the same size and alignment in both languages. Constants are enumerators. All
// definitions are between SHARED_BEGIN and SHARED_END, which put them into C++'s namespace tyndall.
#pragma once

#ifdef __OPENCL_C_VERSION__
#define SHARED_BEGIN
#define SHARED_END
#else
#define SHARED_BEGIN \
  namespace tyndall  \
  {
#define SHARED_END }

// The file is in angle brackets so that EmbedKernels.cmake does not expand this include.
#include <Device/OpenCL.h>

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
