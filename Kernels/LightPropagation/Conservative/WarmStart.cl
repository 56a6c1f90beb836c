#include "LightPropagation/Sweep/MomentPlacesShared.h"

// Magnitude of a source that may be negative: its root mean square over directions, summed over the voxels of a row.
// This is an upper bound on the power it adds or removes. One work-item per row and channel.
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
