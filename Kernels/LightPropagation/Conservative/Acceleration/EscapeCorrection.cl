// Escape correction (EscapeCorrection.h). The host defines GROUP, the number of work-items that together sum over a
// chunk of voxels (GroupSum.cl).

#include "LightPropagation/Scattering/CollectShared.h"
#include "Numerics/GroupSum.cl"

// Subtracts the additional escaped power of each voxel from its path integral (numerics.md, Eq. (46)).
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
