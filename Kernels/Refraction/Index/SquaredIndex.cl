// Squared refractive index n^2 between voxel centres, and its gradient. Lengths are in voxels.
//
// n^2 is a tricubic B-spline with the coefficients of numerics.md, Eq. (88). Its gradient is continuous and exact, as a
// symplectic integrator requires. A coefficient is at least 7/8 of the least and at most 9/8 of the largest n^2 in its
// stencil, so that the spline is positive where n^2 is. Beyond the grid n^2 is extrapolated linearly, but never below a
// quarter of its value at the border. The coefficient of voxel (i, j, k) is at index (i + 2, j + 2, k + 2) of an array
// that is longer by four than the grid along each axis.

#pragma once
#include "Refraction/Index/IndexShared.h"

// n^2 of a voxel. Beyond the grid it is extrapolated from the last two voxels of the row.
static float squared_index_of(const IndexGrid* grid, const __global float* ior, int i, int j, int k)
{
  const bool inside = i >= 0 && i < grid->size[0] && j >= 0 && j < grid->size[1] && k >= 0 && k < grid->size[2];
  if (inside)
  {
    const float n = ior[(k * grid->size[1] + j) * grid->size[0] + i];
    return n * n;
  }
  const int voxel[3] = { i, j, k };
  const int stride[3] = { 1, grid->size[0], grid->size[0] * grid->size[1] };
  int nearest = 0;
  for (int a = 0; a < 3; ++a)
  {
    nearest += stride[a] * clamp(voxel[a], 0, grid->size[a] - 1);
  }
  const float n = ior[nearest], least = 0.25f * n * n;
  float value = n * n;
  for (int a = 0; a < 3; ++a)
  {
    const int beyond = voxel[a] < 0 ? -voxel[a] : max(voxel[a] - grid->size[a] + 1, 0);
    if (beyond > 0 && grid->size[a] > 1)
    {
      const float inner = ior[nearest + (voxel[a] < 0 ? stride[a] : -stride[a])];
      value += beyond * (n - inner) * (n + inner);
    }
  }
  return fmax(value, least);
}

// A coefficient is limited to (1 - OVERSHOOT) times the least and (1 + OVERSHOOT) times the largest n^2 of its stencil.
#define OVERSHOOT 0.125f

// Minimum and maximum without the checks for NaN of fmin and fmax.
static float lesser_of(float a, float b)
{
  return a < b ? a : b;
}

static float greater_of(float a, float b)
{
  return a > b ? a : b;
}

// Computes n^2 in the grid and three voxels beyond it.
//   squares  output: n^2 of each voxel, and of three more at both ends of each axis
__kernel void extend_squared_index(IndexGrid grid, const __global float* ior, __global float* squares)
{
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  squares[(z * (grid.size[1] + 6) + y) * (grid.size[0] + 6) + x] = squared_index_of(&grid, ior, x - 3, y - 3, z - 3);
}

__kernel void squared_index_coefficients(IndexGrid grid, const __global float* squares, __global float* coefficients)
{
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  const int row = grid.size[0] + 6, layer = row * (grid.size[1] + 6);
  const __global float* here = squares + ((z + 1) * layer + (y + 1) * row + x + 1);
  // Scalars take the place of arrays, because PoCL does not keep arrays in registers.
  const float f = here[0], x0 = here[-1], x1 = here[1], y0 = here[-row], y1 = here[row], z0 = here[-layer],
              z1 = here[layer];
  const float low = lesser_of(f, lesser_of(lesser_of(lesser_of(x0, x1), lesser_of(y0, y1)), lesser_of(z0, z1)));
  const float high = greater_of(f, greater_of(greater_of(greater_of(x0, x1), greater_of(y0, y1)), greater_of(z0, z1)));
  const float c = 2.0f * f - (x0 + x1 + y0 + y1 + z0 + z1) / 6.0f;
  const float held = lesser_of(greater_of(c, low - OVERSHOOT * low), high + OVERSHOOT * high);
  coefficients[(z * (grid.size[1] + 4) + y) * (grid.size[0] + 4) + x] = held;
}

// For each coefficient, except near the array's ends, computes the least and the largest of the five coefficients
// around it along one axis. `stride` is the distance of coefficients along the axis.
__kernel void widen_range(
  int stride, const __global float* low, const __global float* high, __global float* low_out, __global float* high_out)
{
  const int i = get_global_id(0) + 2 * stride;
  const __global float* l = low + i;
  const __global float* h = high + i;
  low_out[i] = lesser_of(lesser_of(lesser_of(l[-2 * stride], l[-stride]), lesser_of(l[stride], l[2 * stride])), l[0]);
  high_out[i] =
    greater_of(greater_of(greater_of(h[-2 * stride], h[-stride]), greater_of(h[stride], h[2 * stride])), h[0]);
}

// Values of the four cubic B-spline basis functions, for the first to the fourth coefficient, at distance f, in [0,
// 1], from the second coefficient.
static float4 spline_values(float f)
{
  const float4 squares = (float4)(0.5f, -1.0f, 0.5f, 0.0f) + f * (float4)(-1.0f / 6.0f, 0.5f, -0.5f, 1.0f / 6.0f);
  return (float4)(1.0f / 6.0f, 2.0f / 3.0f, 1.0f / 6.0f, 0.0f) + f * ((float4)(-0.5f, 0.0f, 0.5f, 0.0f) + f * squares);
}

static float4 spline_slopes(float f)
{
  return (float4)(-0.5f, 0.0f, 0.5f, 0.0f) +
    f * ((float4)(1.0f, -2.0f, 1.0f, 0.0f) + f * (float4)(-0.5f, 1.5f, -1.5f, 0.5f));
}

typedef float4 __attribute__((aligned(4))) float4_anywhere;

// Four sums: those of the components of a, of b, of c and of d.
static float4 four_sums(float4 a, float4 b, float4 c, float4 d)
{
  const float4 ab = (float4)(a.x, b.x, a.y, b.y) + (float4)(a.z, b.z, a.w, b.w);
  const float4 cd = (float4)(c.x, d.x, c.y, d.y) + (float4)(c.z, d.z, c.w, d.w);
  return (float4)(ab.lo, cd.lo) + (float4)(ab.hi, cd.hi);
}

// n^2 (w) and its gradient (x, y, z), from the 4^3 coefficients that start at `first`. f is the position in [0, 1]
// between the second and the third coefficient along each axis. Layers are summed first, then rows, so that most
// operations have sixteen components.
static float4 squared_index_among(const __global float* first, int row, int layer, float3 f)
{
  const float4 z = spline_values(f.z), z_slope = spline_slopes(f.z);
  // Differences from `middle` are summed, so that rounding of n^2 itself does not cause a gradient.
  const float middle = first[layer + row + 1];
  float16 value = 0.0f, along_z = 0.0f;
#define ROW(k, j) (*(const __global float4_anywhere*)(first + (k)*layer + (j)*row))
#define ADD_LAYER(k, s)                                                               \
  {                                                                                   \
    const float16 c = (float16)(ROW(k, 0), ROW(k, 1), ROW(k, 2), ROW(k, 3)) - middle; \
    value += z.s * c;                                                                 \
    along_z += z_slope.s * c;                                                         \
  }
  ADD_LAYER(0, s0)
  ADD_LAYER(1, s1)
  ADD_LAYER(2, s2)
  ADD_LAYER(3, s3)
#define SUM_OF_ROWS(a) (((a).s0123 + (a).s4567) + ((a).s89ab + (a).scdef))
  const float16 y = spline_values(f.y).s0000111122223333;
  const float16 along_y = value * spline_slopes(f.y).s0000111122223333;
  value *= y;
  along_z *= y;
  const float4 x = spline_values(f.x), rows = SUM_OF_ROWS(value);
  const float4 sums =
    four_sums(rows * spline_slopes(f.x), SUM_OF_ROWS(along_y) * x, SUM_OF_ROWS(along_z) * x, rows * x);
  return (float4)(sums.xyz, middle + sums.w);
}
