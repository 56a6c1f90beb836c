// Start and end of a sweep: power in the maps of rays. The host defines what Exact.cl requires.

#include "Numerics/Exact.cl"

// Sums the power of the rays in the maps, which leaves at the far end of an axis. One work-item per row of a bundle and
// way.
// maps     [way][bundle][row][member][channel][row_floats], rays in the first `size_u` floats after `border`
// bundles  [bundle] members, first float of its maps
// sums     [way][bundle][row][channel]
__kernel void map_power(const __global float* maps, ulong maps_each_way, const __global int2* bundles, int rows,
  int channels, int row_floats, int border, int size_u, __global float* sums)
{
  const int row = get_global_id(0);
  const int2 bundle = bundles[get_global_id(1)];
  const int way = get_global_id(2);
  maps += way * maps_each_way + bundle.y + (ulong)row * bundle.x * channels * row_floats + border;
  for (int c = 0; c < channels; ++c)
  {
    float total = 0.0f;
    for (int m = 0; m < bundle.x; ++m)
    {
      const __global float* rays = maps + (m * channels + c) * row_floats;
      float4 partial = (float4)(0.0f);
      int x = 0;
      for (; x + 4 <= size_u; x += 4)
      {
        partial += vload4(0, rays + x);
      }
      float rest = 0.0f;
      for (; x < size_u; ++x)
      {
        rest += rays[x];
      }
      total += ((partial.x + partial.y) + (partial.z + partial.w)) + rest;
    }
    sums[((way * get_global_size(1) + get_global_id(1)) * rows + row) * channels + c] = total;
  }
}

// Clears the columns beside a row's voxels, which hold light incident on u's face; there is none once rays wrap around
// a periodic axis. One work-item per row of a bundle and way; arguments as for map_power.
__kernel void darken_beside(__global float* maps, ulong maps_each_way, const __global int2* bundles, int channels,
  int row_floats, int border, int size_u, int width)
{
  const int2 bundle = bundles[get_global_id(1)];
  maps +=
    get_global_id(2) * maps_each_way + bundle.y + (ulong)get_global_id(0) * bundle.x * channels * row_floats + border;
  for (int r = 0; r < bundle.x * channels; ++r)
  {
    for (int x = size_u; x < width; ++x)
    {
      maps[r * row_floats + x] = 0.0f;
    }
  }
}

// For open axes: adds the power of rays that leave at the far end to the cells of that face. One work-item per row of
// the face and way; arguments as for map_power, and
// face_out  the sweep's own escaped power, W, [channel][cell], added to
// first     index of the face's first cell in the first channel, for each way
__kernel void leave_by_cells(const __global float* maps, ulong maps_each_way, const __global int2* bundles,
  int bundle_count, int channels, int row_floats, int border, int size_u, __global exact* face_out, ulong first_forward,
  ulong first_backward, ulong face_stride)
{
  const int row = get_global_id(0);
  const int way = get_global_id(1);
  face_out += (way ? first_backward : first_forward) + (ulong)row * size_u;
  for (int b = 0; b < bundle_count; ++b)
  {
    const __global float* of_bundle =
      maps + way * maps_each_way + bundles[b].y + (ulong)row * bundles[b].x * channels * row_floats + border;
    for (int r = 0; r < bundles[b].x * channels; ++r)
    {
      const __global float* rays = of_bundle + r * row_floats;
      __global exact* out = face_out + r % channels * face_stride;
      for (int x = 0; x < size_u; ++x)
      {
        out[x] += rays[x];
      }
    }
  }
}

// Sums the units' own escaped power by cells, in the order of the units, adds it to face_out and clears it. One
// work-item per value.
__kernel void take_face_cells(__global exact* units, int count, ulong values, __global float* face_out)
{
  const ulong i = get_global_id(0);
  exact sum = 0.0f;
  for (int unit = 0; unit < count; ++unit)
  {
    sum += units[unit * values + i];
    units[unit * values + i] = 0.0f;
  }
  face_out[i] = (float)(face_out[i] + sum);
}

// The inverse of leave_by_cells: adds incident light by cells of the faces where rays start to the maps.
// power    [bundle] power of a ray at radiance 1, length^2 sr
// face_in  W / (length^2 sr), [channel][cell]
__kernel void enter_by_cells(__global float* maps, ulong maps_each_way, const __global int2* bundles,
  const __global float* power, int channels, int row_floats, int border, int size_u, const __global float* face_in,
  ulong first_forward, ulong first_backward, ulong face_stride)
{
  const int row = get_global_id(0);
  const int b = get_global_id(1);
  const int way = get_global_id(2);
  face_in += (way ? first_backward : first_forward) + (ulong)row * size_u;
  maps += way * maps_each_way + bundles[b].y + (ulong)row * bundles[b].x * channels * row_floats + border;
  for (int r = 0; r < bundles[b].x * channels; ++r)
  {
    for (int x = 0; x < size_u; ++x)
    {
      maps[r * row_floats + x] += power[b] * face_in[r % channels * face_stride + x];
    }
  }
}
