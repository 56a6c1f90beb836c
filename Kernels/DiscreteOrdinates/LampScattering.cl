// First-collision source of uncollided light of a lamp, by the phase function between the lamp's ray and each direction
// (numerics.md, Eq. (D12)). Radiance is [group of eight directions][voxel][8 directions]; successive groups are
// `stride` voxels apart. The host defines
//
//   GROUPS  number of groups of eight directions
//   TABLE   number of angles, equidistant from 0 to pi, at which the phase function is tabulated
//   WAYS    1: `ways` gives the mean direction of the light in each voxel; the length of this vector is the fraction of
//              the light along it, and the rest is isotropic;
//           0: light has the direction of the lamp's ray through the centre of the voxel
#include "DiscreteOrdinates/OrdinatesShared.h"

#define MOST_TILT 0.98f // largest |t| in the factor 1 + t cosine of Eq. (D12); equal to MostTilt in LampScattering.cxx

// Direction of a lamp's light in voxel i; 0 in the voxel that contains the lamp, where light is isotropic.
inline float3 from_lamp(const LampInRays* lamp, ulong i)
{
  const float3 place = (float3)(lamp->place[0], lamp->place[1], lamp->place[2]);
  if (lamp->parallel)
  {
    return place;
  }
  const int nx = lamp->size[0], ny = lamp->size[1];
  const float3 voxel = (float3)(i % nx + 0.5f, i / nx % ny + 0.5f, i / nx / ny + 0.5f);
  const float3 spacing = (float3)(lamp->spacing[0], lamp->spacing[1], lamp->spacing[2]);
  const float3 way = voxel * spacing - place;
  const bool inside = all(fabs(way) <= 0.5001f * spacing);
  return inside ? (float3)(0.0f) : way * rsqrt(dot(way, way));
}

// acos(cosine) / pi: sqrt(1 - |c|) times a cubic polynomial, to 7e-5 (Abramowitz and Stegun 4.4.45).
inline float8 angle_of(float8 cosine)
{
  const float8 c = fmin(fabs(cosine), (float8)1.0f);
  const float8 p = sqrt((float8)1.0f - c) * (0.5f + c * (-0.0682776f + c * (0.0236366f - 0.0059614f * c)));
  return select((float8)1.0f - p, p, cosine >= (float8)0.0f);
}

// Phase function at a cosine, 1/sr, interpolated linearly in the table.
inline float8 phase_at(const __global float* table, float8 cosine)
{
  const float8 position = angle_of(cosine) * (float8)(TABLE - 1);
  const int8 i = min(convert_int8(position), (int8)(TABLE - 2));
#define TAKE(add)                                                                                         \
  (float8)(table[i.s0 + add], table[i.s1 + add], table[i.s2 + add], table[i.s3 + add], table[i.s4 + add], \
    table[i.s5 + add], table[i.s6 + add], table[i.s7 + add])
  return mix(TAKE(0), TAKE(1), position - convert_float8(i));
}

inline float sum8(float8 values)
{
  const float4 four = values.lo + values.hi;
  return (four.x + four.y) + (four.z + four.w);
}

// Mean direction of the uncollided light in voxel i.
inline float3 way_of(const LampInRays* lamp, const __global float* ways, ulong i)
{
  return WAYS ? vload3(i, ways) : from_lamp(lamp, i);
}

// Adds uncollided light to fluence and net flux. One work-item per voxel.
//   path     path integrals of the lamp, W length
//   direct   sum of the uncollided fluence of all lamps, W / length^2. The lamp's fluence is added to this array and to
//            `fluence`; if has_flux, its net flux to `flux`, [x, y, z][voxel]
__kernel void add_lamp(const __global float* path, __global float* fluence, __global float* direct,
  __global float* flux, int has_flux, LampInRays lamp, const __global float* ways)
{
  const ulong i = get_global_id(0), voxels = get_global_size(0);
  const float light = path[i] * lamp.perVolume;
  fluence[i] += light;
  direct[i] += light;
  if (has_flux)
  {
    const float3 along = way_of(&lamp, ways, i);
    flux[i] += light * along.x;
    flux[voxels + i] += light * along.y;
    flux[2 * voxels + i] += light * along.z;
  }
}

// Adds the first-collision source of parallel light, which scatters into each direction by the same factor in every
// voxel.
//   source  W / (length^3 sr). On entry the source of a voxel is its element times `scale`; on return, its element
//   parts   [group][8], 1/sr: fraction of the scattered light per solid angle (LampScattering::PartsAlong)
__kernel void scatter_parallel(__global float* source, const __global float* scale, const __global float* path,
  const __global float* sigma_s, const __global float* parts, ulong stride, float per_volume)
{
  const ulong i = get_global_id(0), group = get_global_id(1);
  __global float8* to = (__global float8*)source + group * stride + i;
  *to = *to * scale[i] + ((const __global float8*)parts)[group] * (path[i] * per_volume * sigma_s[i]);
}

// Adds the first-collision source of light whose direction varies by voxel: of a lamp with a position or, with WAYS, of
// given mean directions.
//   source  W / (length^3 sr). On entry the source of a voxel is its element times `scale`; on return, its element
//   omegas  [group][x, y, z, solid angle][8]
//   table   phase function at equidistant angles, 1/sr
//
// The phase function is multiplied by 1 + t cosine and normalised over directions, so that the scattered power is
// exact, and the mean cosine too, unless this requires |t| > MOST_TILT (numerics.md, Eq. (D12)).
__kernel void scatter_from_place(__global float* source, const __global float* scale, const __global float* path,
  const __global float* sigma_s, const __global float* omegas, const __global float* table, ulong stride,
  LampInRays lamp, const __global float* ways)
{
  const ulong i = get_global_id(0);
  const float3 mean_way = way_of(&lamp, ways, i);
  const float directed = WAYS ? fmin(length(mean_way), 1.0f) : 1.0f;
  const float3 along = !WAYS ? mean_way : directed > 0.0f ? normalize(mean_way) : (float3)(0.0f);
  const float evenly = (1.0f - directed) * path[i] * lamp.perVolume * sigma_s[i] / (4.0f * M_PI_F);
  const __global float8* of = (const __global float8*)omegas;
  float8 sums = (float8)0.0f, firsts = (float8)0.0f, seconds = (float8)0.0f;
  for (int group = 0; group < GROUPS; ++group)
  {
    const float8 cosine = along.x * of[4 * group] + along.y * of[4 * group + 1] + along.z * of[4 * group + 2];
    const float8 part = phase_at(table, cosine) * of[4 * group + 3];
    sums += part;
    firsts += part * cosine;
    seconds += part * cosine * cosine;
  }
  const float sum = sum8(sums);
  const float mean = sum8(firsts) / sum, square = sum8(seconds) / sum;
  const float lacking = lamp.meanCosine - mean, slope = square - lamp.meanCosine * mean;
  // If the phase function's forward peak lies within the solid angle of one direction, no t in the factor 1 + t cosine
  // can change its mean cosine, and t is set to its limit. |t| < 1 keeps the factor positive, so that terms of the sum
  // over directions do not cancel.
  const float tilt = slope > 1e-6f ? clamp(lacking / slope, -MOST_TILT, MOST_TILT) : copysign(MOST_TILT, lacking);
  float power = path[i] * lamp.perVolume * sigma_s[i] / (sum * (1.0f + tilt * mean));
  power *= directed;
  for (int group = 0; group < GROUPS; ++group)
  {
    const float8 cosine = along.x * of[4 * group] + along.y * of[4 * group + 1] + along.z * of[4 * group + 2];
    __global float8* to = (__global float8*)source + group * stride + i;
    *to = *to * scale[i] + power * phase_at(table, cosine) * ((float8)1.0f + tilt * cosine);
    if (WAYS)
    {
      *to += evenly;
    }
  }
}
