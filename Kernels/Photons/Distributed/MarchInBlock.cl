// The kernel of photons that march as far as their block goes: part of PhotonMarch.cl, with BLOCKS.

#pragma once

// Photons that have come from other blocks, as load_packet those that set off.
static void resume_packet(const march_arrays* arrays, const __global PhotonOnItsWay* arrived, int first, int end,
  photon_lanes* lanes, photon_flight* flight)
{
  take_over(arrays, arrived, first, end, lanes, flight);
  take_off(arrays, lanes, flight);
  const integer special = to_attend(arrays, lanes, flight);
  if (anywhere(special))
  {
    land(flight, lanes);
    attend(arrays, lanes, flight, special, first);
    take_off(arrays, lanes, flight);
  }
}

static void march_packet_in_block(const march_arrays* arrays, const __global float* photons,
  const __global PhotonOnItsWay* arrived, int resumes, int first, int end)
{
  photon_lanes lanes;
  photon_flight flight;
  if (resumes)
  {
    resume_packet(arrays, arrived, first, end, &lanes, &flight);
  }
  else
  {
    load_packet(arrays, photons, first, end, &lanes, &flight);
  }
  int vertices = 0;
  if (anywhere(flight.alive))
  {
    follow(arrays, &lanes, &flight, first, arrays->info->eventLimit, 0.0f, &vertices);
  }
}

// Photons `first` to `first + count`, of one batch, to their ends or into another block: of `photons`, which set off, or
// with `resumes` of `arrived`. Those that go on elsewhere are put into `gone`, whose number gone_count is, in any order.
// Copies of the batch's sums begin at `copyBegin` and are `copyStride` apart.
__kernel void march_block(MarchInfo info, const __global float* sigma, const __global float* coefficients,
  const __global uchar* nodes, const __global float* photons, const __global ulong* marks,
  const __global PhotonOnItsWay* arrived, __global PhotonOnItsWay* gone, volatile __global int* gone_count,
  __global PhotonEnd* ends, __global long* sums, ulong copyBegin, ulong copyStride, volatile __global int* next, int resumes,
  int first, int count)
{
  const int end = first + count;
#if WORKERS > 0
  const march_arrays arrays = { &info, sigma, coefficients, nodes,
    sums + copyBegin + get_global_id(0) * copyStride, ends, 0, marks, 0, gone, gone_count };
  for (int block = atomic_add(next, BLOCK); block < count; block = atomic_add(next, BLOCK))
  {
    for (int i = first + block; i < first + min(block + BLOCK, count); i += REAL_WIDTH)
    {
      march_packet_in_block(&arrays, photons, arrived, resumes, i, end);
    }
  }
#else
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + copyBegin, ends, 0, marks, 0, gone,
    gone_count };
  march_packet_in_block(&arrays, photons, arrived, resumes, first + get_global_id(0) * REAL_WIDTH, end);
#endif
}
