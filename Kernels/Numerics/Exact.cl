// Type `exact` of Device/ExactValues.h: double, or float if the device has no double precision. The host defines
//   DOUBLES  1 if the device has double precision

#pragma once

#if DOUBLES
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double exact;
typedef double8 exact8;
#else
typedef float exact;
typedef float8 exact8;
#endif
