// The kernels of photons that march as far as their block goes: part of PhotonMarch.cl, with BLOCKS.

#pragma once

// Photons that have come from other blocks, as load_packet those that set off. With PATHS their corners are counted.
static void resume_packet(const march_arrays* arrays, const __global PhotonOnItsWay* arrived, int first, int end,
  photon_lanes* lanes, photon_flight* flight, int* vertices)
{
  take_over(arrays, arrived, first, end, lanes, flight);
  take_off(arrays, lanes, flight);
  const integer corner = to_attend(arrays, lanes, flight);
  const integer special = corner | halted(arrays, flight);
  if (anywhere(special))
  {
    land(flight, lanes);
#if PATHS
    if (corner)
    {
      add_vertex(arrays, lanes, flight, vertices);
    }
#endif
    attend(arrays, lanes, flight, special, first);
    take_off(arrays, lanes, flight);
  }
}

// Returns the vertices of the path, with PATHS: from where the photon set off, but without where it came to the block.
static int march_packet_in_block(const march_arrays* arrays, const __global float* photons,
  const __global PhotonOnItsWay* arrived, int resumes, int first, int end)
{
  photon_lanes lanes;
  photon_flight flight;
  int vertices = 0;
  if (resumes)
  {
    resume_packet(arrays, arrived, first, end, &lanes, &flight, &vertices);
  }
  else
  {
    load_packet(arrays, photons, first, end, &lanes, &flight);
#if PATHS
    add_vertex(arrays, &lanes, &flight, &vertices);
#endif
  }
  if (anywhere(flight.alive))
  {
    follow(arrays, &lanes, &flight, first, arrays->info->eventLimit, &vertices);
  }
  return vertices;
}

#if PATHS
// Parts of paths, a work-item each: of `photons`, which set off, or with `resumes` of `arrived`. Its `counts[i]`
// vertices go to vertices + offsets[i]; with `counting` they are only counted. Photons are told by their marks.
__kernel void trace_in_block(MarchInfo info, const __global float* sigma, const __global float* coefficients,
  const __global uchar* nodes, const __global float* photons, const __global ulong* marks,
  const __global PhotonOnItsWay* arrived, __global PhotonOnItsWay* gone, volatile __global int* gone_count,
  __global PhotonEnd* ends, int counting, const __global int* offsets, __global float4* vertices, __global int* counts,
  int resumes)
{
  const int i = get_global_id(0);
  const march_arrays arrays = { &info, sigma, coefficients, nodes, 0, ends, counting ? 0 : vertices + offsets[i], marks,
    0, gone, gone_count };
  counts[i] = march_packet_in_block(&arrays, photons, arrived, resumes, i, i + 1);
}
#else
// Photons `first` to `first + count`, of one batch, to their ends or into another block: of `photons`, which set off,
// or with `resumes` of `arrived`. Those that go on elsewhere are put into `gone`, whose number gone_count is, in any
// order. Copies of the batch's sums begin at `copyBegin` and are `copyStride` apart.
__kernel void march_block(MarchInfo info, const __global float* sigma, const __global float* coefficients,
  const __global uchar* nodes, const __global float* photons, const __global ulong* marks,
  const __global PhotonOnItsWay* arrived, __global PhotonOnItsWay* gone, volatile __global int* gone_count,
  __global PhotonEnd* ends, __global long* sums, ulong copyBegin, ulong copyStride, volatile __global int* next,
  int resumes, int first, int count, const __global int* cells)
{
  const int end = first + count;
#if WORKERS > 0
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + copyBegin + get_global_id(0) * copyStride,
    ends, 0, marks, cells, gone, gone_count };
  for (int block = atomic_add(next, BLOCK); block < count; block = atomic_add(next, BLOCK))
  {
    for (int i = first + block; i < first + min(block + BLOCK, count); i += REAL_WIDTH)
    {
      march_packet_in_block(&arrays, photons, arrived, resumes, i, end);
    }
  }
#else
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + copyBegin, ends, 0, marks, cells, gone,
    gone_count };
  march_packet_in_block(&arrays, photons, arrived, resumes, first + get_global_id(0) * REAL_WIDTH, end);
#endif
}
#endif
