// How rays bend: half the gradient of n^2, and n^2, of the tricubic spline that photons follow as well, at voxel centres with a
// border of one voxel that repeats the outermost ones.
//
// Between centres both are interpolated linearly. Along a row of voxels the spline's slopes add up to the difference of its ends,
// so that rays through a plane layer leave it as Snell's law has it, however steep it is.
//
// Needs SquaredIndex.cl before it.

#define FLAT 2e-6f // of n^2: what rounding makes of a constant

// bending  x, y, z: half the gradient in voxels by squared spacing: what a velocity in voxels gains per time; w: n^2
kernel void pack_bending(
  index_grid grid, float4 inverse_spacing, global const float* restrict coefficients, global float4* restrict bending)
{
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  const float3 last = (float3)(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1);
  const float3 centre = clamp((float3)(x, y, z) - 1.0f, (float3)(0.0f), last) + 0.5f;
  const float4 spline = squared_index(&grid, coefficients, centre);
  const float3 turn = 0.5f * spline.xyz * inverse_spacing.xyz * inverse_spacing.xyz;
  const int flat = fabs(spline.x) + fabs(spline.y) + fabs(spline.z) <= FLAT * spline.w;
  bending[((size_t)z * (grid.size[1] + 2) + y) * (grid.size[0] + 2) + x] = (float4)(flat ? (float3)(0.0f) : turn, spline.w);
}
