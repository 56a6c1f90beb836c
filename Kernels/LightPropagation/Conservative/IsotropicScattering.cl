// What the sweeps gathered becomes light and the next order's source (Gruson et al., Eq. 4, conservative). The host
// gives
//   SCATTERS  0: sigma_s is zero, and neither it nor `source` is there

#include "LightPropagation/Conservative/CollectShared.h"
#include "Numerics/Numerics.cl"

// A work-item a chunk of a channel; a channel's arrays begin at a vector's border and are filled up with zeros to a
// whole number of vectors.
// path     W length; cleared
// fluence  W / length^2, added to
// source   W / (length^3 sr), replaced by what was scattered
// tally    [channel][chunk] absorbed and scattered W
// first, last  values of a channel, whole vectors: the others have gathered nothing
__kernel void collect(__global float* path, __global float* fluence, __global float* source,
  const __global float* sigma_t, const __global float* sigma_s, __global float2* tally, ulong stride, ulong first,
  ulong last, int one_sigma_t, float per_volume)
{
  const ulong channel = get_global_id(1);
  const ulong begin = first + get_global_id(0) * CollectChunk;
  const ulong end = min(last, begin + CollectChunk);
  path += channel * stride;
  fluence += channel * stride;
  source += channel * stride;
  sigma_s += channel * stride;
  sigma_t += one_sigma_t ? 0 : channel * stride;
  real absorbed = (real)0.0f, scattered = (real)0.0f;
  for (ulong i = begin; i < end; i += REAL_WIDTH)
  {
    const real p = load_real(i, path);
#if SCATTERS
    const real s = load_real(i, sigma_s);
#else
    const real s = (real)0.0f;
#endif
    const real f = multiply_add(p, (real)per_volume, load_real(i, fluence));
    absorbed = multiply_add(fmax(load_real(i, sigma_t) - s, (real)0.0f), p, absorbed);
    scattered = multiply_add(s, p, scattered);
    store_real(f, i, fluence);
#if SCATTERS
    store_real(s * p * (per_volume * M_1_PI_F * 0.25f), i, source);
#endif
    store_real((real)0.0f, i, path);
  }
  tally[channel * get_global_size(0) + get_global_id(0)] = (float2)(sum_of(absorbed), sum_of(scattered));
}

// All that was scattered but what the last order left over: from that, in `source`, and the fluence of all orders. A
// work-item a value of a channel.
__kernel void gather_scattered(
  const __global float* fluence, __global float* source, const __global float* sigma_s, ulong stride)
{
  const ulong i = get_global_id(1) * stride + get_global_id(0);
  source[i] = fmax(sigma_s[i] * fluence[i] * (M_1_PI_F * 0.25f) - source[i], 0.0f);
}

// Light in the voxels outside a box becomes fluence. A work-item a value of a channel.
__kernel void add_outside(const __global float* path, __global float* fluence, ulong stride, float per_volume,
  int3 size, int3 first, int3 filled)
{
  const ulong at = get_global_id(0);
  const int x = (int)(at % size.x) - first.x;
  const int y = (int)(at / size.x % size.y) - first.y;
  const int z = (int)(at / ((ulong)size.x * size.y)) - first.z;
  if (x < 0 || y < 0 || z < 0 || x >= filled.x || y >= filled.y || z >= filled.z)
  {
    const ulong i = get_global_id(1) * stride + at;
    fluence[i] += path[i] * per_volume;
  }
}
