// Packets of photons: each packet has REAL_WIDTH photons, one per vector lane.
//
// The state of a packet is in arrays, read and written for all lanes at once, or lane by lane if a photon needs
// separate treatment. A mask is -1 in selected lanes and 0 in the others; `mask ? a : b` selects by lane.

#pragma once
#include "Numerics/Numerics.cl"

#define LANES(type, name) type name[REAL_WIDTH] __attribute__((aligned(64)))
#define LANES_3(type, name) type name[3][REAL_WIDTH] __attribute__((aligned(64))) // one array per axis x, y, z
#define VECTOR(array) (*(const real*)(array))
#define INTEGERS(array) (*(const integer*)(array))
#define PUT(array, value) (*(real*)(array) = (value))
#define PUT_INTEGERS(array, value) (*(integer*)(array) = (value))
#define PUT_WHERE(mask, array, value) (*(real*)(array) = (mask) ? (value) : VECTOR(array))
#define PUT_INTEGERS_WHERE(mask, array, value) (*(integer*)(array) = (mask) ? (value) : INTEGERS(array))

// Loops over axes and channels are unrolled by pragma. PoCL does not unroll them itself, and it would not keep arrays
// with a variable index in registers.
#define FOR_AXES(a) _Pragma("unroll") for (int a = 0; a < 3; ++a)
#define FOR_CHANNELS(c) _Pragma("unroll") for (int c = 0; c < CHANNELS; ++c)

// Minimum and maximum without the checks for NaN of fmin and fmax.
#define lesser(a, b) ((a) < (b) ? (a) : (b))
#define greater(a, b) ((a) > (b) ? (a) : (b))

#if REAL_WIDTH == 1
#define truth(condition) (-(condition))
#define anywhere(mask) (mask)
#define bits_of(mask) ((mask)&1)
#define as_integer as_int
#define gather(type, values, i) ((values)[i])
#define LANE_BY_LANE(do_it) do_it(0, )
#else
#define truth(condition) (condition)
#define as_integer TYNDALL_JOIN(as_int, REAL_WIDTH)
#if REAL_WIDTH == 4
#define gather(type, values, i) ((type##4)((values)[(i).s0], (values)[(i).s1], (values)[(i).s2], (values)[(i).s3]))
#define LANE_BY_LANE(do_it) do_it(0, .s0) do_it(1, .s1) do_it(2, .s2) do_it(3, .s3)
#elif REAL_WIDTH == 8
#define gather(type, values, i)                                                                        \
  ((type##8)((values)[(i).s0], (values)[(i).s1], (values)[(i).s2], (values)[(i).s3], (values)[(i).s4], \
    (values)[(i).s5], (values)[(i).s6], (values)[(i).s7]))
#define LANE_BY_LANE(do_it) \
  do_it(0, .s0) do_it(1, .s1) do_it(2, .s2) do_it(3, .s3) do_it(4, .s4) do_it(5, .s5) do_it(6, .s6) do_it(7, .s7)
#else
#define gather(type, values, i)                                                                                 \
  ((type##16)((values)[(i).s0], (values)[(i).s1], (values)[(i).s2], (values)[(i).s3], (values)[(i).s4],         \
    (values)[(i).s5], (values)[(i).s6], (values)[(i).s7], (values)[(i).s8], (values)[(i).s9], (values)[(i).sa], \
    (values)[(i).sb], (values)[(i).sc], (values)[(i).sd], (values)[(i).se], (values)[(i).sf]))
#define LANE_BY_LANE(do_it)                                                                                       \
  do_it(0, .s0) do_it(1, .s1) do_it(2, .s2) do_it(3, .s3) do_it(4, .s4) do_it(5, .s5) do_it(6, .s6) do_it(7, .s7) \
    do_it(8, .s8) do_it(9, .s9) do_it(10, .sa) do_it(11, .sb) do_it(12, .sc) do_it(13, .sd) do_it(14, .se)        \
      do_it(15, .sf)
#endif

static int bits_of(integer mask)
{
#if REAL_WIDTH == 4
  const int4 bits = mask & (int4)(1, 2, 4, 8);
#elif REAL_WIDTH == 8
  const int8 bits_8 = mask & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
  const int4 bits = bits_8.lo | bits_8.hi;
#else
  const int16 bits_16 = mask & (int16)(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768);
  const int8 bits_8 = bits_16.lo | bits_16.hi;
  const int4 bits = bits_8.lo | bits_8.hi;
#endif
  const int2 pair = bits.lo | bits.hi;
  return pair.x | pair.y;
}

// Whether a mask selects any lane. The built-in function any is not used, as PoCL compiles it to one branch per lane.
static bool anywhere(integer mask)
{
#if REAL_WIDTH == 4
  return as_uint(convert_char4(mask)) != 0;
#elif REAL_WIDTH == 8
  return as_ulong(convert_char8(mask)) != 0;
#else
  const ulong2 bytes = as_ulong2(convert_char16(mask));
  return (bytes.x | bytes.y) != 0;
#endif
}
#endif
#define masked(mask, value) as_real((mask)&as_integer(value))

// Loops over the lanes k that a mask selects.
#define FOR_LANES(k, mask)                                               \
  for (int k##_left = bits_of(mask), k = first_lane(k##_left); k##_left; \
       k##_left &= k##_left - 1, k = first_lane(k##_left))

static int first_lane(int bits)
{
  return 31 - clz(bits & -bits);
}
