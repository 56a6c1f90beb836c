// Scattering of radiance between the directions in each voxel, by the N terms of a separable phase function or by its
// full matrix (numerics.md, Eqs. (D7), (D8)). Radiance is [group of eight directions][voxel][8 directions]; successive
// groups are `stride` voxels apart, which is at least the number of voxels. The host defines
//
//   REAL_WIDTH  number of moments in a vector
//   GROUPS      number of groups of eight directions
//   TERMS       N, number of terms of the phase function
//   ROWS        number of vectors of REAL_WIDTH for the moments of a voxel: fluence, the terms, net flux
//   FLUX        1: net flux is computed; it follows the terms among the moments
//   POSITIVE    1: negative sources are set to 0, and positive ones scaled to conserve the scattered power
#include "DiscreteOrdinates/OrdinatesShared.h"
#include "Numerics/Numerics.cl"

#define BLOCK OrdinateBlock // number of voxels per work-item
#define MOMENTS (ROWS * REAL_WIDTH)

typedef float8 float8_anywhere __attribute__((aligned(4)));
#define LOAD8(index, pointer) (*(const __global float8_anywhere*)((pointer) + (index)))
#define STORE8(value, index, pointer) (*(__global float8_anywhere*)((pointer) + (index)) = (value))

#define EACH_VOXEL(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)

inline float sum8(float8 values)
{
  const float4 four = values.lo + values.hi;
  return (four.x + four.y) + (four.z + four.w);
}

// Whether a block of eight voxels lies outside the box that contains all light, along x or y. Positions along z are not
// compared.
inline bool is_beside(ScatteringVoxels at, ulong first)
{
  if (at.width == 0)
  {
    return false;
  }
  const int row = (int)(first / (ulong)at.width % (ulong)at.height);
  const int column = (int)(first % (ulong)at.width);
  return column + BLOCK <= at.width &&
    (row < at.first[1] || row > at.last[1] || column > at.last[0] || column + BLOCK <= at.first[0]);
}

// Whether any of eight voxels scatters.
inline bool any_scatters(const __global float* sigma_s, ulong voxels, ulong first)
{
  bool any = false;
#define LOOK(b) any |= first + b < voxels && sigma_s[first + b] > 0.0f;
  EACH_VOXEL(LOOK)
  return any;
}

// Computes the angular moments of eight voxels, [voxel][MOMENTS], from their radiance. Adds the directions group by
// group, and then the groups, so that rounding errors are the same in all voxels of equal radiance.
//   weights  [direction][MOMENTS]: weight of each direction in each moment, sr
inline void find_moments(
  const __global float* radiance, const __global float* weights, ulong stride, ulong first, __global float* moments)
{
  for (int row = 0; row < ROWS; ++row)
  {
#define CLEAR(b) real sum##b = (real)0.0f;
    EACH_VOXEL(CLEAR)
    for (int group = 0; group < GROUPS; ++group)
    {
      const __global float* in = radiance + (group * stride + first) * 8;
      const __global float* of = weights + (group * 8) * MOMENTS + row * REAL_WIDTH;
#define CLEAR_PART(b) real part##b = (real)0.0f;
      EACH_VOXEL(CLEAR_PART)
      for (int lane = 0; lane < 8; ++lane)
      {
        const real weight = load_real(lane * MOMENTS, of);
#define GATHER(b) part##b = multiply_add(weight, (real)in[8 * b + lane], part##b);
        EACH_VOXEL(GATHER)
      }
#define ADD_PART(b) sum##b += part##b;
      EACH_VOXEL(ADD_PART)
    }
#define KEEP(b) store_real(sum##b, (first + b) * MOMENTS + row * REAL_WIDTH, moments);
    EACH_VOXEL(KEEP)
  }
}

// Writes the fluence of eight voxels in this scattering order to `order`. Adds their fluence and net flux to the sums
// over all orders, `fluence` and `flux`.
inline void add_light(const __global float* moments, ulong voxels, ulong first, __global float* order,
  __global float* fluence, __global float* flux)
{
  for (int b = 0; b < BLOCK; ++b)
  {
    const ulong i = first + b;
    if (i < voxels)
    {
      order[i] = moments[i * MOMENTS];
      fluence[i] += moments[i * MOMENTS];
      for (int a = 0; FLUX && a < 3; ++a)
      {
        flux[a * voxels + i] += moments[i * MOMENTS + 1 + TERMS + a];
      }
    }
  }
}

// Macros for the source of voxel b (0 to 7) in eight directions. With POSITIVE, POSITIVE_PART sets negative sources to
// 0, and NOTE_SCALE writes the factor by which the remaining sources must be multiplied to conserve power.
#define POSITIVE_PART(b)                                            \
  source##b = POSITIVE ? fmax(source##b, (float8)0.0f) : source##b; \
  power##b = multiply_add8(angle, source##b, power##b);
#define CLEAR_POWER(b) float8 power##b = (float8)0.0f;
#define NOTE_SCALE(b)                                                              \
  {                                                                                \
    const float all = sum8(power##b);                                              \
    if (POSITIVE && first + b < voxels)                                            \
      scale[first + b] = all > 0.0f ? moments[(first + b) * MOMENTS] / all : 0.0f; \
  }
#if defined(FP_FAST_FMAF) || defined(__FMA__)
#define multiply_add8(a, b, c) fma(a, b, c)
#else
#define multiply_add8(a, b, c) mad(a, b, c)
#endif
#define CLEAR_SOURCE(b) float8 source##b = (float8)0.0f;
#define STORE_SOURCE(b)   \
  if (first + b < voxels) \
    STORE8(source##b* sigma_s[first + b], (group * stride + first + b) * 8, source);

// Computes fluence and net flux of eight voxels that do not scatter, and sets their source to 0.
inline void pass_empty(const __global float* radiance, __global float* source, const __global float* weights,
  const __global float* angles, ScatteringVoxels at, ulong first, __global float* moments)
{
  const ulong voxels = at.voxels, stride = at.stride;
  if (FLUX)
  {
    find_moments(radiance, weights, stride, first, moments);
  }
#define CLEAR_LIGHT(b) float8 light##b = (float8)0.0f;
  EACH_VOXEL(CLEAR_LIGHT)
  for (int group = 0; group < GROUPS; ++group)
  {
    const float8 angle = LOAD8(group * 8, angles);
#define TAKE_LIGHT(b) light##b = multiply_add8(angle, LOAD8((group * stride + first + b) * 8, radiance), light##b);
    EACH_VOXEL(TAKE_LIGHT)
#define STORE_NOTHING(b)  \
  if (first + b < voxels) \
    STORE8((float8)0.0f, (group * stride + first + b) * 8, source);
    EACH_VOXEL(STORE_NOTHING)
  }
#define KEEP_LIGHT(b) moments[(first + b) * MOMENTS] = sum8(light##b);
  EACH_VOXEL(KEEP_LIGHT)
}

// Adds the light of eight voxels without medium. For these voxels the sweep has stored sums of the radiance over the
// directions of each group, not the radiance along each direction.
inline void take_sums(const __global float* radiance, ScatteringVoxels at, ulong first, __global float* order,
  __global float* fluence, __global float* flux)
{
  for (int k = 0; k < (FLUX ? 4 : 1); ++k)
  {
    float8 sum = (float8)0.0f;
    for (int group = 0; group < GROUPS; ++group)
    {
      sum += LOAD8((group * at.stride + first + k) * 8, radiance);
    }
    __global float* all = k == 0 ? fluence : flux + (k - 1) * at.voxels;
    STORE8(LOAD8(first, all) + sum, first, all);
    if (k == 0)
    {
      STORE8(sum, first, order);
    }
  }
}

// Computes the angular moments of eight voxels, and adds their light to fluence and net flux, with the arguments of
// scatter_terms. Returns whether the source must still be computed from the moments; it is set to 0 here if the voxels
// do not scatter. Voxels outside the box with light are not changed.
inline bool take_light(const __global float* radiance, __global float* source, __global float* moments,
  const __global float* weights, const __global float* angles, const __global float* sigma_s, __global float* order,
  __global float* fluence, __global float* flux, const __global uchar* empty, ScatteringVoxels at, ulong first)
{
  if (is_beside(at, first))
  {
    return false;
  }
  if (at.hasSums && first < at.voxels && empty[first / BLOCK])
  {
    take_sums(radiance, at, first, order, fluence, flux);
    return false;
  }
  const bool scatters = !at.skips || any_scatters(sigma_s, at.voxels, first);
  if (scatters)
  {
    find_moments(radiance, weights, at.stride, first, moments);
  }
  else
  {
    pass_empty(radiance, source, weights, angles, at, first, moments);
  }
  add_light(moments, at.voxels, first, order, fluence, flux);
  return scatters;
}

// Scatters by the terms of the phase function. One work-item per BLOCK voxels.
//   radiance  W / (length^2 sr), padded by BLOCK voxels
//   source    scattering source, W / (length^3 sr); may be the array `radiance`. With POSITIVE it must still be
//             multiplied by the voxel's value in `scale`
//   moments   scratch, [voxel][MOMENTS], padded by BLOCK voxels
//   spread    [group][term][8]: factor of each term in the source of each direction
//   angles    [group][8]: weights of the directions, sr
//   order     fluence of this scattering order, W / length^2; it is also added to `fluence`, and net flux to `flux`
//   empty     whether each block of voxels has no medium, if at.hasSums
__kernel void scatter_terms(const __global float* radiance, __global float* source, __global float* moments,
  const __global float* weights, const __global float* spread, const __global float* angles,
  const __global float* sigma_s, __global float* order, __global float* fluence, __global float* flux,
  __global float* scale, const __global uchar* empty, ScatteringVoxels at)
{
  const ulong voxels = at.voxels, stride = at.stride;
  const ulong first = at.begin + get_global_id(0) * BLOCK;
  if (!take_light(radiance, source, moments, weights, angles, sigma_s, order, fluence, flux, empty, at, first))
  {
    return;
  }
  const __global float* mine = moments + first * MOMENTS + 1;
  EACH_VOXEL(CLEAR_POWER)
  for (int group = 0; group < GROUPS; ++group)
  {
    const float8 angle = LOAD8(group * 8, angles);
    EACH_VOXEL(CLEAR_SOURCE)
    for (int term = 0; term < TERMS; ++term)
    {
      const float8 factor = LOAD8((group * TERMS + term) * 8, spread);
#define SPREAD(b) source##b = multiply_add8(factor, (float8)mine[b * MOMENTS + term], source##b);
      EACH_VOXEL(SPREAD)
    }
    EACH_VOXEL(POSITIVE_PART)
    EACH_VOXEL(STORE_SOURCE)
  }
  EACH_VOXEL(NOTE_SCALE)
}

// Scatters by the full matrix, with the arguments of scatter_terms; source and radiance must be different arrays.
//   matrix  [group][incident direction][8]: phase function, 1/sr, times the weight of the incident direction, sr
__kernel void scatter_matrix(const __global float* radiance, __global float* source, __global float* moments,
  const __global float* weights, const __global float* matrix, const __global float* angles,
  const __global float* sigma_s, __global float* order, __global float* fluence, __global float* flux,
  __global float* scale, const __global uchar* empty, ScatteringVoxels at)
{
  const ulong voxels = at.voxels, stride = at.stride;
  const ulong first = at.begin + get_global_id(0) * BLOCK;
  if (!take_light(radiance, source, moments, weights, angles, sigma_s, order, fluence, flux, empty, at, first))
  {
    return;
  }
  EACH_VOXEL(CLEAR_POWER)
  for (int group = 0; group < GROUPS; ++group)
  {
    const float8 angle = LOAD8(group * 8, angles);
    EACH_VOXEL(CLEAR_SOURCE)
    for (int other = 0; other < GROUPS; ++other)
    {
      const __global float* in = radiance + (other * stride + first) * 8;
      for (int lane = 0; lane < 8; ++lane)
      {
        const float8 part = LOAD8(((group * GROUPS + other) * 8 + lane) * 8, matrix);
#define FROM_DIRECTION(b) source##b = multiply_add8(part, (float8)in[8 * b + lane], source##b);
        EACH_VOXEL(FROM_DIRECTION)
      }
    }
    EACH_VOXEL(POSITIVE_PART)
    EACH_VOXEL(STORE_SOURCE)
  }
  EACH_VOXEL(NOTE_SCALE)
}

// Scatters into one direction by the full matrix, as published without factorisation (Gong et al., Eq. (13)). One
// work-item per voxel.
//   row          [incident direction]: phase function into the outgoing direction, times the weight of the incident one
//   group, lane  indices of the outgoing direction: its group, and its place among the eight of the group
__kernel void scatter_along(const __global float* radiance, __global float* source, const __global float* row,
  const __global float* sigma_s, int group, int lane, ulong stride)
{
  const ulong i = get_global_id(0);
  float8 sum = (float8)0.0f;
  for (int other = 0; other < GROUPS; ++other)
  {
    sum = multiply_add8(LOAD8(other * 8, row), LOAD8((other * stride + i) * 8, radiance), sum);
  }
  source[(group * stride + i) * 8 + lane] = sigma_s[i] * sum8(sum);
}

// Adds the fluence and net flux of `radiance` to `fluence` and `flux`, without scattering.
__kernel void gather_light(const __global float* radiance, __global float* moments, const __global float* weights,
  __global float* order, __global float* fluence, __global float* flux, ScatteringVoxels at)
{
  const ulong voxels = at.voxels, stride = at.stride;
  const ulong first = at.begin + get_global_id(0) * BLOCK;
  find_moments(radiance, weights, stride, first, moments);
  add_light(moments, voxels, first, order, fluence, flux);
}
