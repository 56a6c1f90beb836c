// The medium as photons need it. The host gives
//   MEDIUM_CHANNELS, BENDS, LEVELS  as PhotonMarch.cl wants them
//   A_CHANNELS, S_CHANNELS          components of sigma_a and sigma_s, 0: there is none

#include "Numerics/Numerics.cl"
#include "Refraction/Index/SquaredIndex.cl"

#define OUTSIDE -3e38f
#define FLAT 2e-6f // of n^2: what rounding makes of a constant
#define component(values, count, voxel, c) \
  ((count) == 0 ? 0.0f : (values)[(voxel) * (count) + ((count) == 3 ? (c) : 0)])

// sigma  [MEDIUM_CHANNELS][padded] extinction over `diagonal`, OUTSIDE in the padding; its sign bit says that n^2
//        varies within the reach of interpolation (low, high: the range of coefficients, in their padding)
// nodes  [padded] 0: it does not vary; else 1 + the voxel's octree level
__kernel void pack_extinction(IndexGrid grid, float diagonal, const __global float* sigma_a,
  const __global float* sigma_s, const __global float* low, const __global float* high, const __global uchar* levels,
  __global float* sigma, __global uchar* nodes)
{
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  const int row = grid.size[0] + 2, layer = row * (grid.size[1] + 2);
  const size_t copy = (size_t)layer * (grid.size[2] + 2), at = (size_t)z * layer + y * row + x;
  const bool inside = x > 0 && x <= grid.size[0] && y > 0 && y <= grid.size[1] && z > 0 && z <= grid.size[2];
  const size_t voxel = ((size_t)(z - 1) * grid.size[1] + y - 1) * grid.size[0] + x - 1;
  bool varies = false;
#if BENDS
  const size_t i = ((size_t)(z + 1) * (grid.size[1] + 4) + y + 1) * (grid.size[0] + 4) + x + 1;
  varies = inside && high[i] - low[i] > FLAT * high[i];
  nodes[at] = varies ? 1 + (LEVELS ? levels[voxel] : 0) : 0;
#endif
  for (int c = 0; c < MEDIUM_CHANNELS; ++c)
  {
    float s = OUTSIDE;
    if (inside)
    {
      const float extinction = component(sigma_a, A_CHANNELS, voxel, c) + component(sigma_s, S_CHANNELS, voxel, c);
      s = fmin(diagonal * extinction, 1e30f); // endless, and times no length, it would be no number
      s = varies ? -s : s;
    }
    sigma[c * copy + at] = s;
  }
}

// [padded] the coarse cell of each voxel, of cells[0] times cells[1] times cells[2]; 0 in the padding.
__kernel void assign_cells(IndexGrid grid, IndexGrid cells, __global int* cell)
{
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  const bool inside = x > 0 && x <= grid.size[0] && y > 0 && y <= grid.size[1] && z > 0 && z <= grid.size[2];
  const int i = (long)(x - 1) * cells.size[0] / grid.size[0];
  const int j = (long)(y - 1) * cells.size[1] / grid.size[1];
  const int k = (long)(z - 1) * cells.size[2] / grid.size[2];
  const size_t at = ((size_t)z * (grid.size[1] + 2) + y) * (grid.size[0] + 2) + x;
  cell[at] = inside ? (k * cells.size[1] + j) * cells.size[0] + i : 0;
}
