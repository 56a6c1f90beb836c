// From light that was found to what is scattered of it (Gruson et al., Eq. 4, conservative). The host gives
//   REAL_WIDTH  4 or 8 floats of a vector
//   GROUP       work-items that take a chunk together (GroupSum.cl)
//   DOUBLES     1 where the device has double precision
//   SCATTERS    0: sigma_s is zero; `scatter_order` does not read it and writes no source. The other kernels are for
//               media that scatter.

#include "LightPropagation/Scattering/CollectShared.h"
#include "Numerics/Exact.cl"
#include "Numerics/GroupSum.cl"
#include "Numerics/Numerics.cl"

#define ADDED_UP 32 // vectors

// One order: what the sweep gathered becomes light and the next source. A work-group a chunk of a channel; a channel's
// arrays begin at a vector's border and are filled up with zeros to a whole number of vectors.
// path     W length; cleared
// fluence  W / length^2, added to
// source   W / (length^3 sr), replaced by what was scattered
// tally    [channel][chunk] absorbed and scattered W
// first, last  values of a channel, whole vectors: the others have gathered nothing
__kernel void scatter_order(__global float* path, __global float* fluence, __global float* source,
  const __global float* sigma_t, const __global float* sigma_s, __global float2* tally, ulong stride, ulong first,
  ulong last, int one_sigma_t, float per_volume)
{
  const ulong channel = get_global_id(1);
  const ulong begin = first + get_group_id(0) * CollectChunk;
  const ulong end = min(last, begin + CollectChunk), step = STEP_IN_CHUNK(REAL_WIDTH);
  path += channel * stride;
  fluence += channel * stride;
  source += channel * stride;
  sigma_s += channel * stride;
  sigma_t += one_sigma_t ? 0 : channel * stride;
  real absorbed = (real)0.0f, scattered = (real)0.0f;
  // In two steps: floats lose digits where as many are added up one by one as a chunk has.
  for (ulong part = begin + FIRST_IN_CHUNK(REAL_WIDTH); part < end; part += ADDED_UP * step)
  {
    real absorbed_of_part = (real)0.0f, scattered_of_part = (real)0.0f;
    const ulong end_of_part = min(end, part + ADDED_UP * step);
    for (ulong i = part; i < end_of_part; i += step)
    {
      const real p = load_real(i, path);
#if SCATTERS
      const real s = load_real(i, sigma_s);
#else
      const real s = (real)0.0f;
#endif
      const real f = multiply_add(p, (real)per_volume, load_real(i, fluence));
      absorbed_of_part = multiply_add(fmax(load_real(i, sigma_t) - s, (real)0.0f), p, absorbed_of_part);
      scattered_of_part = multiply_add(s, p, scattered_of_part);
      store_real(f, i, fluence);
#if SCATTERS
      store_real(s * p * (per_volume * M_1_PI_F * 0.25f), i, source);
#endif
      store_real((real)0.0f, i, path);
    }
    absorbed += absorbed_of_part;
    scattered += scattered_of_part;
  }
  const float2 sum = (float2)(sum_of(absorbed), sum_of(scattered));
  PUT_SUM_OF_GROUP(float2, sum, tally[channel * get_num_groups(0) + get_group_id(0)])
}

// All that was scattered but what the last order left over: from that, in `source`, and the fluence of all orders. A
// work-item a value of a channel.
__kernel void scatter_all_orders(
  const __global float* fluence, __global float* source, const __global float* sigma_s, ulong stride)
{
  const ulong i = get_global_id(1) * stride + get_global_id(0);
  source[i] = fmax(sigma_s[i] * fluence[i] * (M_1_PI_F * 0.25f) - source[i], 0.0f);
}

// What is scattered of light that has met nothing yet. A work-item a value of a channel.
// path    W length
// volume  4 pi times that of a voxel
__kernel void add_first_scattered(
  const __global float* path, __global float* source, const __global float* sigma_s, ulong stride, exact volume)
{
  const ulong i = get_global_id(1) * stride + get_global_id(0);
  source[i] += (float)((exact)sigma_s[i] * path[i] / volume);
}

// The source of a channel, which begins at `first` in all arrays but `fluence`: what is given and what is scattered. A
// work-item a voxel. A diffusion system's fluence can be negative.
__kernel void scatter_fluence(const __global exact* fluence, const __global float* given, __global float* source,
  const __global float* sigma_s, ulong first)
{
  const ulong i = get_global_id(0);
  const ulong at = first + i;
  source[at] = fmax(given[at] + sigma_s[at] * fmax((float)fluence[i], 0.0f) * (0.25f * M_1_PI_F), 0.0f);
}
