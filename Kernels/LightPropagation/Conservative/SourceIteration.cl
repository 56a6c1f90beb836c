// Kernels of source iteration. The host defines GROUP, the number of work-items that together sum over a chunk of
// voxels (GroupSum.cl).

#include "LightPropagation/Scattering/CollectShared.h"
#include "LightPropagation/Sweep/MomentPlacesShared.h"
#include "Numerics/GroupSum.cl"

// Adds the path integrals of a sweep to the fluence of all voxels outside a box. One work-item per voxel and channel.
//   path     W length, [channel][voxel], `stride` values per channel
//   fluence  W / length^2, [channel][voxel]; path integrals per volume are added to it
//   first, filled  first voxel and size of the box
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

// Computes the magnitude of a source that may be negative: the root mean square over directions in each voxel, summed
// over the voxels of a row (numerics.md, Eq. (46c)). It bounds the power that the source adds or removes. One work-item
// per row and channel.
//   source  W / (length^3 sr), with its angular moments (MomentPlacesShared.h)
//   tally   [channel][row]
__kernel void sum_magnitudes(MomentPlaces places, const __global float* source, __global float* tally, ulong stride)
{
  const ulong line = get_global_id(0);
  const ulong channel = get_global_id(1);
  float sum = 0.0f;
  for (int x = 0; x < places.sizeX; ++x)
  {
    const float mean = source[channel * stride + line * places.sizeX + x];
    float square = mean * mean;
    for (int q = 1; q < places.functions; ++q)
    {
      const float moment = source[MOMENT_PLACE(places, q, channel, line, x)];
      square += moment * moment;
    }
    sum += sqrt(square);
  }
  tally[channel * get_global_size(0) + line] = sum;
}

// Subtracts the additional escaped power of each voxel from its path integral (EscapeCorrection.h; numerics.md, Eq.
// (46)).
//   path    path integrals of the sweep, W length
//   source  source of the sweep, W / (length^3 sr)
//   extra   path integral to subtract for a source of 1, W length
//   tally   additional escaped power, W, [channel][chunk]
__kernel void let_escape(__global float* path, const __global float* source, const __global float* extra,
  const __global float* sigma_t, __global float* tally, ulong stride, int one_sigma_t)
{
  const ulong channel = get_global_id(1);
  const ulong begin = get_group_id(0) * CollectChunk;
  const ulong end = min(stride, begin + CollectChunk);
  path += channel * stride;
  source += channel * stride;
  extra += channel * stride;
  sigma_t += one_sigma_t ? 0 : channel * stride;
  float sum = 0.0f;
  for (ulong i = begin + FIRST_IN_CHUNK(1); i < end; i += STEP_IN_CHUNK(1))
  {
    const float escapes = source[i] * extra[i];
    path[i] -= escapes;
    sum += sigma_t[i] * escapes;
  }
  PUT_SUM_OF_GROUP(float, sum, tally[channel * get_num_groups(0) + get_group_id(0)])
}
