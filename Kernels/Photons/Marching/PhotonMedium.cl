// Kernels that pack the medium for the marching kernels.

#include "Numerics/Numerics.cl"
#include "Refraction/Index/SquaredIndex.cl"

#define OUTSIDE -3e38f
#define FLAT 2e-6f // relative variation of n^2 that counts as rounding of a constant
#define component(values, count, voxel, c) \
  ((count) == 0 ? 0.0f : (values)[(voxel) * (count) + ((count) == 3 ? (c) : 0)])

// Whether n^2 varies in a voxel, within the reach of the spline interpolation.
//   low, high  least and largest spline coefficient of n^2 near each voxel, in the padded layout of these coefficients
static bool index_varies(
  const IndexGrid* known, const __global float* low, const __global float* high, int x, int y, int z)
{
  const size_t i = ((size_t)(z + 2) * (known->size[1] + 4) + y + 2) * (known->size[0] + 4) + x + 2;
  return high[i] - low[i] > FLAT * high[i];
}

// Packs the extinction of the voxels.
//   x0, y0, z0  first voxel of the grid within the region `known`, where the index is known
//   channels, of_a, of_s  channels of the extinction; components of sigma_a and sigma_s, 0: absent
//   low, high   as in index_varies: bounds of the spline coefficients of n^2 near each voxel; read only if `bends`
//   sigma       [channel][voxel of the padded grid] optical thickness of a voxel diagonal, OUTSIDE in the padding; sign
//               bit set where n^2 varies
__kernel void pack_extinction(IndexGrid grid, IndexGrid known, int x0, int y0, int z0, float diagonal, int channels,
  int of_a, int of_s, int bends, const __global float* sigma_a, const __global float* sigma_s,
  const __global float* low, const __global float* high, __global float* sigma)
{
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  const int row = grid.size[0] + 2, layer = row * (grid.size[1] + 2);
  const size_t copy = (size_t)layer * (grid.size[2] + 2), at = (size_t)z * layer + y * row + x;
  const bool inside = x > 0 && x <= grid.size[0] && y > 0 && y <= grid.size[1] && z > 0 && z <= grid.size[2];
  const size_t voxel = ((size_t)(z - 1) * grid.size[1] + y - 1) * grid.size[0] + x - 1;
  const bool varies = bends && inside && index_varies(&known, low, high, x0 + x - 1, y0 + y - 1, z0 + z - 1);
  for (int c = 0; c < channels; ++c)
  {
    float s = OUTSIDE;
    if (inside)
    {
      const float extinction = component(sigma_a, of_a, voxel, c) + component(sigma_s, of_s, voxel, c);
      s = fmin(diagonal * extinction, 1e30f); // infinity times zero length would be NaN
      s = varies ? -s : s;
    }
    sigma[c * copy + at] = s;
  }
}

// Packs the octree nodes of the region in which the index is known.
//   levels  octree level of each voxel; read only if has_levels
//   nodes  [voxel of `known` with its padding] 0: n^2 does not vary in the voxel; else 1 + the voxel's octree level
__kernel void pack_nodes(IndexGrid known, const __global float* low, const __global float* high, int has_levels,
  const __global uchar* levels, __global uchar* nodes)
{
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  const int nx = known.size[0], ny = known.size[1];
  const bool inside = x > 0 && x <= nx && y > 0 && y <= ny && z > 0 && z <= known.size[2];
  const bool varies = inside && index_varies(&known, low, high, x - 1, y - 1, z - 1);
  const size_t voxel = ((size_t)(z - 1) * ny + y - 1) * nx + x - 1;
  nodes[((size_t)z * (ny + 2) + y) * (nx + 2) + x] = varies ? 1 + (has_levels ? levels[voxel] : 0) : 0;
}

// Computes the coarse cell of each voxel of a block.
//   x0, y0, z0  first voxel of the block in the domain `whole`
//   cells       number of coarse cells along each axis of the domain
//   cell        [voxel of the padded grid] index of the coarse cell, x fastest; 0 in the padding
__kernel void assign_cells(IndexGrid grid, IndexGrid whole, int x0, int y0, int z0, IndexGrid cells, __global int* cell)
{
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  const bool inside = x > 0 && x <= grid.size[0] && y > 0 && y <= grid.size[1] && z > 0 && z <= grid.size[2];
  const int i = (long)(x0 + x - 1) * cells.size[0] / whole.size[0];
  const int j = (long)(y0 + y - 1) * cells.size[1] / whole.size[1];
  const int k = (long)(z0 + z - 1) * cells.size[2] / whole.size[2];
  const size_t at = ((size_t)z * (grid.size[1] + 2) + y) * (grid.size[0] + 2) + x;
  cell[at] = inside ? (k * cells.size[1] + j) * cells.size[0] + i : 0;
}
