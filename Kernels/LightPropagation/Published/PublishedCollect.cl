// Collection as published (Gruson et al. 2012, Algorithm 2, second half): each voxel reads the temporary buffers of all
// directions and updates the source U and the scattered radiance I. The host defines
//   CHANNELS  1 or 3
//   MOMENTS   number of moments: the fluence, and more if scattering is anisotropic
//   COLOURED  1 if sigma has CHANNELS channels, 0 if all share one
//
// A moment is the sum over directions of a coefficient times T. Directions are added one by one in a fixed order, so
// that the result does not depend on how directions are divided into batches.

#include "LightPropagation/Published/PublishedShared.h"
#include "Numerics/Numerics.cl"

// Adds the deposits of a batch of directions to the moments, REAL_WIDTH voxels at a time. Voxels are in either of the
// two memory layouts, [z][y][x] or [x][z][y] (PublishedLayouts).
//   coefficients   [MOMENTS][directions], starting at index `first`
//   contributions  T over sigma_s, [direction][CHANNELS][volume], length W / (length^2 sr)
//   moments        [MOMENTS][CHANNELS][volume]
//   add            0: first batch of the order, moments are overwritten; 1: they are added to
__kernel void add_directions(const int volume, const int directions, const int add, const int first,
  __global const float* coefficients, __global const float* contributions, __global float* moments)
{
  const int voxel = get_global_id(0) * REAL_WIDTH;
  const int channel = get_global_id(1);
  if (voxel >= volume)
  {
    return;
  }
  contributions += (ulong)channel * volume + voxel;
  moments += (ulong)channel * volume + voxel;
  for (int k = 0; k < MOMENTS; ++k)
  {
    real sum = add ? load_real((ulong)k * CHANNELS * volume, moments) : (real)0.0f;
    for (int i = 0; i < directions; ++i)
    {
      const real t = load_real((ulong)i * CHANNELS * volume, contributions);
      sum = multiply_add((real)coefficients[first + k * directions + i], t, sum);
    }
    store_real(sum, (ulong)k * CHANNELS * volume, moments);
  }
}

// Computes the source U of the next order (Eq. (4)), and adds the moments of this order to the sums over all orders so
// far. One work-item per voxel and channel.
//   moments0, moments1  moments of this order from the directions whose ray maps use memory layout 0, [z][y][x], and
//                       from those that use layout 1, [x][z][y]; moments0 receives their sum
//   totals              moments of all orders, [MOMENTS][CHANNELS][voxel in layout 0]; the kernel adds to them
//   part                the moment and the factor that give each source U; an array of `parts` elements
__kernel void update_sources(const PublishedLayouts info, const int parts, __global const PublishedPart* part,
  __global const float* sigma_s, __global float* moments0, __global const float* moments1, __global float* totals,
  __global float* sources0, __global float* sources1)
{
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  const int z = get_global_id(2) / CHANNELS;
  const int channel = get_global_id(2) % CHANNELS;
  if (x >= info.size[0] || y >= info.size[1])
  {
    return;
  }
  const ulong voxel0 = (ulong)z * info.plane[0] + y * info.row[0] + x;
  const ulong voxel1 = (ulong)x * info.plane[1] + z * info.row[1] + y;
  for (int k = 0; k < MOMENTS; ++k)
  {
    const ulong at = (ulong)(k * CHANNELS + channel) * info.volume[0] + voxel0;
    const float sum = moments0[at] + moments1[(ulong)(k * CHANNELS + channel) * info.volume[1] + voxel1];
    moments0[at] = sum;
    totals[at] += sum;
  }
  const float scattering = sigma_s[voxel0 + (COLOURED ? (ulong)channel * info.volume[0] : 0)];
  for (int p = 0; p < parts; ++p)
  {
    const ulong moment = (ulong)(part[p].moment * CHANNELS + channel) * info.volume[0] + voxel0;
    const float value = part[p].factor * scattering * moments0[moment];
    const ulong slot = part[p].slot * CHANNELS + channel;
    if (part[p].layout == 0)
    {
      sources0[slot * info.volume[0] + voxel0] = value;
    }
    else
    {
      sources1[slot * info.volume[1] + voxel1] = value;
    }
  }
}
