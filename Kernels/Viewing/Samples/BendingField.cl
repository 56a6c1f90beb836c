// Packs the field that bends rays: half the gradient of n^2, and n^2 itself, n the refractive index. Both are taken
// from the tricubic spline that photons also follow, at voxel centres with a border of one voxel that repeats the
// outermost voxels.
//
// Between voxel centres, gradient and n^2 are interpolated linearly. Rays through a plane layer then leave it according
// to Snell's law, for any gradient (numerics.md, section 14.3).

#include "Refraction/Index/SquaredIndex.cl"

// A gradient of n^2 up to this fraction of n^2 is the rounding error of a constant index.
#define FLAT 2e-6f

// Value and slope of a cubic B-spline at the middle of three adjacent coefficients.
#define SPLINE_VALUE(low, middle, high) (((low) + (high)) * (1.0f / 6.0f) + (middle) * (2.0f / 3.0f))
#define SPLINE_SLOPE(low, high) (0.5f * ((high) - (low)))

// Computes `bending`, one element per voxel with border: x, y, z is half the gradient of n^2 in voxels, divided by the
// squared spacing, i.e. the acceleration of a ray in voxels per time squared; w is n^2. Written without loops or
// branches, so that PoCL vectorises over voxels.
__kernel void pack_bending(IndexGrid grid, float4 inverse_spacing, __global const float* restrict coefficients,
  __global float4* restrict bending)
{
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  if (x >= grid.size[0] + 2)
  {
    return;
  }
  const int row = grid.size[0] + 4, layer = row * (grid.size[1] + 4);
  __global const float* c = coefficients +
    ((clamp(z - 1, 0, grid.size[2] - 1) + 2) * layer + (clamp(y - 1, 0, grid.size[1] - 1) + 2) * row +
      clamp(x - 1, 0, grid.size[0] - 1) + 2);
#define SPLINE_ROW(name, at)                                   \
  const float name = SPLINE_VALUE((at)[-1], (at)[0], (at)[1]); \
  const float name##_x = SPLINE_SLOPE((at)[-1], (at)[1]);
#define SPLINE_LAYER(name, at)                                                       \
  SPLINE_ROW(name##_low, (at)-row)                                                   \
  SPLINE_ROW(name##_middle, at)                                                      \
  SPLINE_ROW(name##_high, (at) + row)                                                \
  const float name = SPLINE_VALUE(name##_low, name##_middle, name##_high);           \
  const float name##_x = SPLINE_VALUE(name##_low_x, name##_middle_x, name##_high_x); \
  const float name##_y = SPLINE_SLOPE(name##_low, name##_high);
  SPLINE_LAYER(below, c - layer)
  SPLINE_LAYER(here, c)
  SPLINE_LAYER(above, c + layer)
#undef SPLINE_LAYER
#undef SPLINE_ROW
  const float square = SPLINE_VALUE(below, here, above);
  const float along_x = SPLINE_VALUE(below_x, here_x, above_x);
  const float along_y = SPLINE_VALUE(below_y, here_y, above_y);
  const float along_z = SPLINE_SLOPE(below, above);
  const float kept = fabs(along_x) + fabs(along_y) + fabs(along_z) <= FLAT * square ? 0.0f : 0.5f;
  bending[((size_t)z * (grid.size[1] + 2) + y) * (grid.size[0] + 2) + x] =
    (float4)(kept * along_x * inverse_spacing.x * inverse_spacing.x,
      kept * along_y * inverse_spacing.y * inverse_spacing.y, kept * along_z * inverse_spacing.z * inverse_spacing.z,
      square);
}
