// Kernels for the start and end of a sweep on GPUs: they initialise rays, and sum the deposits of the lanes (each the
// rays that march in one sense along an axis). The host defines
//   CHANNELS   channels swept together
//   FUNCTIONS  number of angular functions; 1: fluence only

#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"

// Sets the power of a lane's rays (those that march in one sense along an axis) where they start, W. One work-item per
// float of the lane's maps (power of each ray).
__kernel void start_rays(
  int first_lane, const __global SweepLane* lanes, const __global float4* entering, __global float* maps)
{
  const __global SweepLane* lane = lanes + first_lane + get_global_id(1);
  const ulong plane = (ulong)lane->planes.sizeU * lane->planes.sizeV;
  const ulong i = get_global_id(0);
  if (i < plane * lane->rays * CHANNELS)
  {
    maps[lane->map + i] = entering[lane->firstRay * CHANNELS + i / plane].z;
  }
}

// Sums each row of floats, in order and with compensated (Kahan) summation. One work-item per row.
__kernel void sum_rows(const __global float* rows, ulong first, int length, __global float* sums, ulong first_sum)
{
  const __global float* row = rows + first + (ulong)get_global_id(0) * length;
  float sum = 0.0f, rounding = 0.0f;
  for (int i = 0; i < length; ++i)
  {
    const float y = row[i] - rounding;
    const float t = sum + y;
    rounding = (t - sum) - y;
    sum = t;
  }
  sums[first_sum + get_global_id(0)] = sum;
}

// Adds the lanes' own arrays of deposits to `sum`; a lane is the rays of one sense along an axis. Lanes are added in
// their order, so the result is identical, bit for bit, to that of lanes that add to `sum` one after another. One
// work-item per value.
__kernel void add_lanes(const __global float* of_lanes, int lanes, ulong values, __global float* sum, ulong first)
{
  const ulong i = get_global_id(0);
  float all = sum[first + i];
  for (int lane = 0; lane < lanes; ++lane)
  {
    all += of_lanes[lane * values + i];
  }
  sum[first + i] = all;
}

// Adds the lanes' own arrays of angular moments to `sum`, in the order of the lanes. A lane is the rays of one sense
// along an axis. One work-item per voxel, function and channel.
__kernel void add_moments_of_lanes(
  PlaneLaunch launch, const __global float* of_lanes, int lanes, __global float* sum, ulong first)
{
  const ulong voxel = get_global_id(0), stride = launch.stride;
  const int k = get_global_id(1) / CHANNELS, c = get_global_id(1) % CHANNELS;
  const MomentPlaces* of = &launch.moments;
  __global float* to = sum +
    (k == 0 ? first + c * stride + voxel
            : MOMENT_PLACE(*of, k, launch.firstChannel + c, voxel / of->sizeX, voxel % of->sizeX));
  float all = *to;
  for (int lane = 0; lane < lanes; ++lane)
  {
    all += of_lanes[(((ulong)lane * FUNCTIONS + k) * CHANNELS + c) * stride + voxel];
  }
  *to = all;
}
