// Numbers as Device/ExactValues.h holds them. The host gives
//   DOUBLES  1 where the device has double precision

#pragma once

#if DOUBLES
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double exact;
typedef double8 exact8;
#else
typedef float exact;
typedef float8 exact8;
#endif
