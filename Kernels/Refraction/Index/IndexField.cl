// Kernels that smooth the refractive index and compute its gradient. The host defines RADIUS, half the width of the
// filter in voxels.

#include "Numerics/Numerics.cl"

// Weighted mean of n over the 2 RADIUS + 1 voxels along an axis. Beyond the grid its last voxel is repeated.
//   n         pointer to the value of voxel number `place` of the `length` voxels along the axis, which are `stride`
//             values apart
//   weights   weights of the voxels at distances 1, 2, ..., RADIUS
// The sum is over differences from n[0], so that a constant n is reproduced to the last bit.
inline float smoothed(__global const float* n, int place, int length, long stride, __constant const float* weights)
{
  const float here = n[0];
  float sum = 0.0f;
#pragma unroll
  for (int k = 1; k <= RADIUS; ++k)
  {
    const float below = n[(max(place - k, 0) - place) * stride];
    const float above = n[(min(place + k, length - 1) - place) * stride];
    sum = multiply_add((below - here) + (above - here), weights[k - 1], sum);
  }
  return here + sum;
}

// Function `smoothed` for a vector of neighbouring voxels along x. If the axis is x, the filter must not reach beyond
// the grid.
inline real smoothed_together(
  __global const float* n, int place, int length, long stride, __constant const float* weights)
{
  const real here = load_real(0, n);
  real sum = (real)0.0f;
#pragma unroll
  for (int k = 1; k <= RADIUS; ++k)
  {
    const real below = load_real((max(place - k, 0) - place) * stride, n);
    const real above = load_real((min(place + k, length - 1) - place) * stride, n);
    sum = multiply_add((below - here) + (above - here), (real)weights[k - 1], sum);
  }
  return here + sum;
}

// Smooths n along one axis; each work-item smooths REAL_WIDTH voxels along x.
__kernel void smooth_index(
  int4 size, int axis, __constant const float* weights, __global const float* n, __global float* result)
{
  const int x = get_global_id(0) * REAL_WIDTH;
  const int y = get_global_id(1);
  const int z = get_global_id(2);
  if (x >= size.x || y >= size.y || z >= size.z)
  {
    return;
  }
  const long voxel = ((long)z * size.y + y) * size.x + x;
  const int length = axis == 0 ? size.x : axis == 1 ? size.y : size.z;
  const int place = axis == 0 ? x : axis == 1 ? y : z;
  const long stride = axis == 0 ? 1 : axis == 1 ? size.x : (long)size.x * size.y;
  const int inner = axis != 0 || (x >= RADIUS && x + REAL_WIDTH + RADIUS <= size.x);
  if (inner && x + REAL_WIDTH <= size.x)
  {
    store_real(smoothed_together(n + voxel, place, length, stride, weights), voxel, result);
    return;
  }
  for (int lane = 0; lane < REAL_WIDTH && x + lane < size.x; ++lane)
  {
    result[voxel + lane] = smoothed(n + voxel + lane, place + (axis == 0 ? lane : 0), length, stride, weights);
  }
}

// Gradient of n by central differences, 1/length; one-sided in the grid's outermost voxels.
//   firstLayer   first layer along z whose gradient is computed; `gradient` begins with this layer
__kernel void index_gradient(
  int4 size, int firstLayer, int layers, float4 spacing, __global const float* n, __global float* gradient)
{
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  const int layer = get_global_id(2);
  if (x >= size.x || y >= size.y || layer >= layers)
  {
    return;
  }
  const int3 here = (int3)(x, y, firstLayer + layer);
  const int3 below = max(here - 1, 0);
  const int3 above = min(here + 1, size.xyz - 1);
  const long layerSize = (long)size.x * size.y;
  const long row = here.z * layerSize + (long)here.y * size.x;
  const float3 high = (float3)(n[row + above.x], n[here.z * layerSize + (long)above.y * size.x + x],
    n[above.z * layerSize + (long)here.y * size.x + x]);
  const float3 low = (float3)(n[row + below.x], n[here.z * layerSize + (long)below.y * size.x + x],
    n[below.z * layerSize + (long)here.y * size.x + x]);
  const float3 apart = convert_float3(max(above - below, 1)) * spacing.xyz;
  vstore3((high - low) / apart, layer * layerSize + (long)y * size.x + x, gradient);
}
