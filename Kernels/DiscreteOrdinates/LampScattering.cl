// Uncollided light of a lamp, scattered for the first time: exactly in angle, by the phase function between its ray and
// each direction (numerics.md, Eq. (D12)).
//
//   GROUPS  of eight directions
//   TABLE   values of the phase function over the angle, evenly from 0 to pi
//   POINT   1: the lamp is at a place; 0: its rays are parallel
#include "DiscreteOrdinates/LampScatteringShared.h"

// Cubic in the square root of 1 - |c|, to 7e-5 (Abramowitz and Stegun 4.4.45), in units of pi.
inline float angle_of(float cosine)
{
  const float c = fmin(fabs(cosine), 1.0f);
  const float p = sqrt(1.0f - c) * (0.5f + c * (-0.0682776f + c * (0.0236366f - 0.0059614f * c)));
  return cosine >= 0.0f ? p : 1.0f - p;
}

// Not negative: the phase function as a set of directions can have it.
inline float phase_at(const __global float* table, float cosine)
{
  const float position = angle_of(cosine) * (TABLE - 1);
  const int i = min((int)position, TABLE - 2);
  return mix(table[i], table[i + 1], position - i);
}

//   source  W / (length^3 sr), [group][voxel][8], over scale; afterwards scale is 1
//   path    W length, of the lamp
//   omegas  [group][x, y, z, solid angle][8]
//   flux    W / length^2, [x, y, z][voxel], added to, if has_flux
__kernel void scatter_lamp(__global float* source, __global float* scale, const __global float* path,
  const __global float* sigma_s, const __global float* omegas, const __global float* table, __global float* fluence,
  __global float* direct, __global float* flux, int has_flux, LampInRays lamp)
{
  const ulong voxels = get_global_size(0), i = get_global_id(0);
  const int nx = lamp.size[0], ny = lamp.size[1];
  float3 along = (float3)(lamp.place[0], lamp.place[1], lamp.place[2]);
#if POINT
  const float3 at = (float3)((i % nx + 0.5f) * lamp.spacing[0], (i / nx % ny + 0.5f) * lamp.spacing[1],
    (i / nx / ny + 0.5f) * lamp.spacing[2]);
  const float3 way = at - along;
  const float length_squared = dot(way, way);
  along = length_squared > 0.0f ? way * rsqrt(length_squared) : (float3)(0.0f, 0.0f, 1.0f);
#endif
  const float light = path[i] * lamp.perVolume;
  fluence[i] += light;
  direct[i] += light;
  for (int a = 0; a < 3 && has_flux; ++a)
  {
    flux[a * voxels + i] += light * (a == 0 ? along.x : a == 1 ? along.y : along.z);
  }
  // The directions' sums of 1, the cosine and its square: what is scattered is made to have the power and, as far as
  // no direction gets less than nothing, the mean cosine that it should have.
  float sum = 0.0f, first = 0.0f, second = 0.0f;
  for (int d = 0; d < GROUPS * 8; ++d)
  {
    const __global float* of = omegas + d / 8 * 32 + d % 8;
    const float cosine = along.x * of[0] + along.y * of[8] + along.z * of[16];
    const float part = phase_at(table, cosine) * of[24];
    sum += part;
    first += part * cosine;
    second += part * cosine * cosine;
  }
  const float mean = first / sum, square = second / sum;
  const float tilt = clamp((lamp.meanCosine - mean) / (square - lamp.meanCosine * mean), -1.0f, 1.0f);
  const float power = light * sigma_s[i] / (sum * (1.0f + tilt * mean));
  const float before = scale[i];
  scale[i] = 1.0f;
  for (int d = 0; d < GROUPS * 8; ++d)
  {
    const __global float* of = omegas + d / 8 * 32 + d % 8;
    const float cosine = along.x * of[0] + along.y * of[8] + along.z * of[16];
    const ulong to = (d / 8 * voxels + i) * 8 + d % 8;
    source[to] = source[to] * before + power * phase_at(table, cosine) * (1.0f + tilt * cosine);
  }
}
