// Source of isotropic scattering (Gruson et al. 2012, Eq. 4, in conservative form). The host defines
//   REAL_WIDTH  4 or 8, floats per vector
//   GROUP       number of work-items that sum over one chunk (GroupSum.cl)
//   DOUBLES     1 if the device has double precision
//   SCATTERS    0: sigma_s is zero; `scatter_order` does not read it and writes no source. The other kernels are used
//               only for media that scatter.

#include "LightPropagation/Scattering/CollectShared.h"
#include "Numerics/Exact.cl"
#include "Numerics/GroupSum.cl"
#include "Numerics/Numerics.cl"

#define ADDED_UP 32 // number of vectors per partial sum

// Processes one scattering order: converts the path integrals of a sweep to fluence and to the next source. One
// work-group per chunk of a channel; the arrays of a channel start at a vector boundary and are padded with zeros to
// whole vectors.
//   path         W length; set to 0
//   fluence      W / length^2, added to
//   source       W / (length^3 sr), overwritten
//   tally        absorbed and scattered power, W, [channel][chunk]
//   first, last  index range of a channel, in whole vectors; the path integrals outside it are 0
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
  // Sums in two steps: adding all values of a chunk to one sum would lose digits in float.
  for (ulong part = begin + FIRST_IN_CHUNK(REAL_WIDTH); part < end; part += ADDED_UP * step)
  {
    real absorbed_of_part = (real)0.0f, scattered_of_part = (real)0.0f;
    const ulong end_of_part = min(end, part + ADDED_UP * step);
    for (ulong i = part; i < end_of_part; i += step)
    {
      const real p = load_real(i, path);
      const real s = SCATTERS ? load_real(i, sigma_s) : (real)0.0f;
      const real f = multiply_add(p, (real)per_volume, load_real(i, fluence));
      absorbed_of_part = multiply_add(fmax(load_real(i, sigma_t) - s, (real)0.0f), p, absorbed_of_part);
      scattered_of_part = multiply_add(s, p, scattered_of_part);
      store_real(f, i, fluence);
      if (SCATTERS)
      {
        store_real(s * p * (per_volume * M_1_PI_F * 0.25f), i, source);
      }
      store_real((real)0.0f, i, path);
    }
    absorbed += absorbed_of_part;
    scattered += scattered_of_part;
  }
  const float2 sum = (float2)(sum_of(absorbed), sum_of(scattered));
  PUT_SUM_OF_GROUP(float2, sum, tally[channel * get_num_groups(0) + get_group_id(0)])
}

// Computes the source of all orders from their fluence, minus the source of the last order, which has not been swept
// and is in `source` on entry (numerics.md, Eq. (44)). One work-item per value of a channel.
__kernel void scatter_all_orders(
  const __global float* fluence, __global float* source, const __global float* sigma_s, ulong stride)
{
  const ulong i = get_global_id(1) * stride + get_global_id(0);
  source[i] = fmax(sigma_s[i] * fluence[i] * (M_1_PI_F * 0.25f) - source[i], 0.0f);
}

// Adds the first-collision source of uncollided light to `source`. One work-item per value of a channel.
//   path    path integrals of uncollided light, W length
//   volume  4 pi times the volume of a voxel
__kernel void add_first_scattered(
  const __global float* path, __global float* source, const __global float* sigma_s, ulong stride, exact volume)
{
  const ulong i = get_global_id(1) * stride + get_global_id(0);
  source[i] += (float)((exact)sigma_s[i] * path[i] / volume);
}

// Sets `source` to the given source (emission and first collisions) plus the scattering source, for one channel, which
// starts at index `first` in all arrays except `fluence`. One work-item per voxel. Negative values of the fluence,
// which a diffusion system may return, count as 0.
__kernel void scatter_fluence(const __global exact* fluence, const __global float* given, __global float* source,
  const __global float* sigma_s, ulong first)
{
  const ulong i = get_global_id(0);
  const ulong at = first + i;
  source[at] = fmax(given[at] + sigma_s[at] * fmax((float)fluence[i], 0.0f) * (0.25f * M_1_PI_F), 0.0f);
}
