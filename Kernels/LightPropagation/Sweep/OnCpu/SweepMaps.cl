// Kernels for the start and end of a sweep, on the maps, which hold the power of each ray. The host defines the options
// of Exact.cl.

#include "LightPropagation/Sweep/SweepShared.h"
#include "Numerics/Exact.cl"

// Index in the maps of the first ray of a row of a bundle; the rays of the bundle's other directions (members) and
// channels, [member][channel], follow at distances of `row` floats.
static ulong row_of_maps(const MapsInfo* info, const __global BundleInfo* bundle, int row, int way)
{
  return way * info->eachWay + bundle->map + (ulong)row * bundle->members * info->channels * info->row + info->border;
}

// Sums the power of the rays in the maps, W. On an open axis this power escapes at the far end. One work-item per row
// of a bundle and sense of marching.
// sums     [sense][bundle][row][channel]
__kernel void map_power(
  MapsInfo info, const __global float* maps, const __global BundleInfo* bundles, __global float* sums)
{
  const int row = get_global_id(0), b = get_global_id(1), way = get_global_id(2);
  maps += row_of_maps(&info, bundles + b, row, way);
  for (int c = 0; c < info.channels; ++c)
  {
    float total = 0.0f;
    for (int m = 0; m < bundles[b].members; ++m)
    {
      const __global float* rays = maps + (m * info.channels + c) * info.row;
      float4 partial = (float4)(0.0f);
      int x = 0;
      for (; x + 4 <= info.sizeU; x += 4)
      {
        partial += vload4(0, rays + x);
      }
      float rest = 0.0f;
      for (; x < info.sizeU; ++x)
      {
        rest += rays[x];
      }
      total += ((partial.x + partial.y) + (partial.z + partial.w)) + rest;
    }
    sums[((way * info.bundles + b) * get_global_size(0) + row) * info.channels + c] = total;
  }
}

// Clears the columns at both ends of a row, which hold the power of rays that enter through the faces normal to u. No
// light is incident any more once rays wrap around a periodic axis. One work-item per row of a bundle and sense of
// marching.
__kernel void darken_beside(MapsInfo info, __global float* maps, const __global BundleInfo* bundles)
{
  const __global BundleInfo* bundle = bundles + get_global_id(1);
  maps += row_of_maps(&info, bundle, get_global_id(0), get_global_id(2));
  for (int r = 0; r < bundle->members * info.channels; ++r)
  {
    for (int x = info.sizeU; x < info.width; ++x)
    {
      maps[r * info.row + x] = 0.0f;
    }
  }
}

// For open axes: adds the power of rays that leave at the far end to the cells of that face. One work-item per row of
// the face and sense of marching.
// face_out  escaped power summed by this sweep, W, [channel][cell]; the kernel adds to it
__kernel void leave_by_cells(
  MapsInfo info, const __global float* maps, const __global BundleInfo* bundles, __global exact* face_out)
{
  const int row = get_global_id(0), way = get_global_id(1);
  face_out += info.face[way] + (ulong)row * info.sizeU;
  for (int b = 0; b < info.bundles; ++b)
  {
    const __global float* of_bundle = maps + row_of_maps(&info, bundles + b, row, way);
    for (int r = 0; r < bundles[b].members * info.channels; ++r)
    {
      const __global float* rays = of_bundle + r * info.row;
      __global exact* out = face_out + r % info.channels * info.faceStride;
      for (int x = 0; x < info.sizeU; ++x)
      {
        out[x] += rays[x];
      }
    }
  }
}

// Adds the escaped power per cell to face_out. The work-items of `sweep` have summed it separately; their sums are
// added in the order of the work-items, and then cleared. One work-item per value.
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

// Adds to the maps the light that is incident through each cell of the faces where rays start. One work-item per row of
// a bundle and sense of marching.
// face_in  incident radiance, W / (length^2 sr), [channel][cell]
__kernel void enter_by_cells(
  MapsInfo info, __global float* maps, const __global BundleInfo* bundles, const __global float* face_in)
{
  const int row = get_global_id(0), way = get_global_id(2);
  const __global BundleInfo* bundle = bundles + get_global_id(1);
  face_in += info.face[way] + (ulong)row * info.sizeU;
  maps += row_of_maps(&info, bundle, row, way);
  for (int r = 0; r < bundle->members * info.channels; ++r)
  {
    for (int x = 0; x < info.sizeU; ++x)
    {
      maps[r * info.row + x] += bundle->power * face_in[r % info.channels * info.faceStride + x];
    }
  }
}
