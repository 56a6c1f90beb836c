// Anderson mixing of the last three results of an iteration (AndersonMixing.h). Options:
//   GROUP    number of work-items that sum a chunk (GroupSum.cl)
//   DOUBLES  1: the device has double precision

#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "Numerics/Exact.cl"
#include "Numerics/GroupSum.cl"

// Computes the sums for Anderson mixing (numerics.md, Eqs. (71), (72)) of a chunk of values. With the change f = found
// - given, and its differences d1, d2 from the changes of the two previous iterations, these are the sums of the
// products d1 d1, d1 d2, d2 d2, d1 f, d2 f over all values, and of f^2 and found^2 over the voxels' fluences (the first
// value of each voxel), weighted by sigma_s.
//   change1, change2  changes of the two previous iterations
//   sums              receives the sums, [chunk][AndersonSums]
__kernel void anderson_sums(const __global exact* given, const __global exact* found, const __global float* change1,
  const __global float* change2, const __global float* sigma_s, int first, float length, int voxels, int count,
  __global exact* sums)
{
  const int begin = get_group_id(0) * DiffusionChunk;
  const int end = min(count, begin + DiffusionChunk);
  exact sum[AndersonSums] = { 0, 0, 0, 0, 0, 0, 0, 0 };
  for (int i = begin + FIRST_IN_CHUNK(1); i < end; i += STEP_IN_CHUNK(1))
  {
    const float scatters = sigma_s[first + i % voxels];
    if (scatters < 0.0f)
    {
      continue; // a ghost voxel: only the rank that owns it adds its values
    }
    const exact tau = i < voxels ? scatters * length : 0;
    const exact f = found[i] - given[i];
    const exact d1 = f - change1[i];
    const exact d2 = f - change2[i];
    const exact weight = tau / (1 + tau);
    sum[0] += weight * f * f;
    sum[1] += weight * found[i] * found[i];
    sum[2] += d1 * d1;
    sum[3] += d1 * d2;
    sum[4] += d2 * d2;
    sum[5] += d1 * f;
    sum[6] += d2 * f;
  }
  // The last of the eight elements is padding and remains 0.
  const exact8 all = (exact8)(sum[0], sum[1], sum[2], sum[3], sum[4], sum[5], sum[6], sum[7]);
  __global exact8* of_chunks = (__global exact8*)sums;
  PUT_SUM_OF_GROUP(exact8, all, of_chunks[get_group_id(0)])
}

// given = found - w1 (found - found1) - w2 (found - found2), with the weights w1 and w2 of AndersonMixing::WeightsBy().
// Overwrites found2 by found, and change2 by found - given.
//   found1, found2  results of the previous iteration and of the one before it
__kernel void anderson_step(__global exact* given, const __global exact* found, const __global float* found1,
  __global float* found2, __global float* change2, float w1, float w2)
{
  const int i = get_global_id(0);
  const exact now = found[i];
  const exact f = now - given[i];
  given[i] = now - w1 * (now - found1[i]) - w2 * (now - found2[i]);
  found2[i] = (float)now;
  change2[i] = (float)f;
}
