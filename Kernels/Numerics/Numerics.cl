// Numerics shared by all kernels that trace light through a medium. REAL_WIDTH must be defined before, as 1, 4, 8 or
// 16. `real` is then a float or a vector of this many floats, and all functions work on either.

#pragma once

#ifndef REAL_WIDTH
#define REAL_WIDTH 1
#endif
#define TYNDALL_JOIN_(a, b) a##b
#define TYNDALL_JOIN(a, b) TYNDALL_JOIN_(a, b)
#if REAL_WIDTH == 1
typedef float real;
typedef int integer;
#define as_real as_float
#define to_integer convert_int
#define to_real convert_float
#define load_real(index, pointer) ((pointer)[index])
#define store_real(value, index, pointer) ((pointer)[index] = (value))
#else
typedef TYNDALL_JOIN(float, REAL_WIDTH) real;
typedef TYNDALL_JOIN(int, REAL_WIDTH) integer;
#define as_real TYNDALL_JOIN(as_float, REAL_WIDTH)
#define to_integer TYNDALL_JOIN(convert_int, REAL_WIDTH)
#define to_real TYNDALL_JOIN(convert_float, REAL_WIDTH)
// Loads and stores of unaligned vectors. They take the place of vload and vstore, because PoCL splits a vstore into
// pieces of four floats.
typedef real __attribute__((aligned(4))) real_anywhere;
#define load_real(index, pointer) (*(const __global real_anywhere*)((pointer) + (index)))
#define store_real(value, index, pointer) (*(__global real_anywhere*)((pointer) + (index)) = (value))
#endif

// multiply_add(a, b, c) = a b + c, in one instruction if the device has one; PoCL's mad takes two.
#if defined(FP_FAST_FMAF) || defined(__FMA__)
#define multiply_add fma
#else
#define multiply_add mad
#endif

// Rounds to the nearest integer, for |x| < 2^22. Adding 1.5 * 2^23 leaves no mantissa bits for a fraction. PoCL's rint
// takes fifteen instructions.
inline real nearest_whole(real x)
{
  return (x + (real)12582912.0f) - (real)12582912.0f;
}

inline float sum_of(real values)
{
#if REAL_WIDTH == 16
  const float8 a = values.lo + values.hi;
  const float4 b = a.lo + a.hi;
  return (b.x + b.y) + (b.z + b.w);
#elif REAL_WIDTH == 8
  const float4 b = values.lo + values.hi;
  return (b.x + b.y) + (b.z + b.w);
#elif REAL_WIDTH == 4
  return (values.x + values.y) + (values.z + values.w);
#else
  return values;
#endif
}

// Fraction of light removed over an optical length, 1 - exp(-tau), to a few units in the last place for every tau >= 0.
// `left` receives the transmittance, exp(-tau). Computed as
//   exp(-tau) = 2^n (1 + q), q = expm1(r), r = -tau - n ln 2 in [-ln 2 / 2, ln 2 / 2]
// so that there is no cancellation for small tau. PoCL's exp is scalar and takes five times as long.
inline real extinguished(real tau, real* left)
{
  const real t = fmin(tau, (real)87.0f); // exp(-87) is about 2^-126, the smallest normal number
  const real n = nearest_whole(t * (real)-1.44269504f);
  const real r = multiply_add(n, (real)2.12194440e-4f, multiply_add(n, (real)-0.693359375f, -t));
  real p = multiply_add(r, (real)1.98412698e-4f, (real)1.38888889e-3f);
  p = multiply_add(p, r, (real)8.33333333e-3f);
  p = multiply_add(p, r, (real)4.16666667e-2f);
  p = multiply_add(p, r, (real)1.66666667e-1f);
  p = multiply_add(p, r, (real)0.5f);
  const real q = multiply_add(p * r, r, r);
  const real two_n = as_real((to_integer(n) + 127) << 23);
  *left = multiply_add(two_n, q, two_n);
  return multiply_add(-two_n, q, (real)1.0f - two_n);
}
