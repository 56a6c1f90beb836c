// Numbers as Device/ExactValues.h holds them. The host gives
//   DOUBLES  1 where the device has double precision

#pragma once

#ifdef __clang__ // warns that other machines pass wide vectors otherwise; nobody calls these functions from there
#pragma clang diagnostic ignored "-Wpsabi"
#endif
#if DOUBLES
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double exact;
typedef double8 exact8;
#else
typedef float exact;
typedef float8 exact8;
#endif
