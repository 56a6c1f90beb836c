#include "LightPropagation/Scattering/CollectShared.h"

// Of a source that can be negative, the root mean square over all directions, summed over the voxels of a chunk: at
// least the power that it adds or takes. A work-item a chunk of a channel.
//   source  W / (length^3 sr), angular moments [function][channel][stride]
//   tally   [channel][chunk]
__kernel void sum_magnitudes(
  const __global float* source, __global float* tally, ulong stride, ulong function_stride, int functions)
{
  const ulong channel = get_global_id(1);
  const ulong begin = get_global_id(0) * CollectChunk;
  const ulong end = min(stride, begin + CollectChunk);
  source += channel * stride;
  float sum = 0.0f;
  for (ulong i = begin; i < end; ++i)
  {
    float square = 0.0f;
    for (int q = 0; q < functions; ++q)
    {
      const float moment = source[q * function_stride + i];
      square += moment * moment;
    }
    sum += sqrt(square);
  }
  tally[channel * get_global_size(0) + get_global_id(0)] = sum;
}
