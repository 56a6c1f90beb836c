// The kernel of scattered photons that go as far as their block goes: part of ScatterPhotons.cl, with BLOCKS.

#pragma once

typedef struct
{
  const __global float* photons;             // that set out, as of scatter_photons
  const __global ulong* numbers;             // of these
  const __global ScatteredOnItsWay* arrived; // others, that have come from other blocks
  __global ScatteredOnItsWay* gone;          // into other blocks, in any order
  volatile __global int* gone_count;
} photons_of_block;

// Photon i of those that set out or, with `resumes`, of those that have arrived.
static ScatterEnd end_in_block(const march_arrays* arrays, const scattering* medium, const ScatterInfo* how,
  const photons_of_block* photons, int resumes, int i)
{
  photon_lanes lanes;
  scattered_flight flight;
  if (!resumes)
  {
    set_out(arrays, how, photons->photons + (ulong)i * PHOTON_FLOATS, photons->numbers[i], &lanes, &flight);
  }
  else
  {
    take_over(arrays, how, photons->arrived + i, &lanes, &flight);
    if (flight.events > 0)
    {
      arrive(arrays, &lanes, &flight.end);
    }
    else
    {
      begin(arrays, &lanes, vload3(0, photons->arrived[i].way.start), vload3(0, photons->arrived[i].way.velocity));
    }
  }
  follow(arrays, medium, how, &lanes, &flight);
  if (flight.end.face == Elsewhere)
  {
    hand_on(arrays, &lanes, &flight, photons->gone + atomic_add(photons->gone_count, 1));
  }
  return flight.end;
}

__kernel void scatter_in_block(MarchInfo info, ScatterInfo how, const __global float* sigma,
  const __global float* coefficients, const __global uchar* nodes, const __global float2* optical,
  const __global float* phase, const __global float* photons, const __global ulong* numbers,
  const __global ScatteredOnItsWay* arrived, __global ScatteredOnItsWay* gone, volatile __global int* gone_count,
  int resumes, __global ScatterEnd* ends, __global long* sums, ulong copyStride, volatile __global int* next, int first,
  int count)
{
  const scattering medium = { optical, phase };
  const photons_of_block all = { photons, numbers, arrived, gone, gone_count };
#if WORKERS > 0
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + get_global_id(0) * copyStride };
  for (int block = atomic_add(next, BLOCK); block < count; block = atomic_add(next, BLOCK))
  {
    for (int i = first + block; i < first + min(block + BLOCK, count); ++i)
    {
      ends[i] = end_in_block(&arrays, &medium, &how, &all, resumes, i);
    }
  }
#else
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums };
  const int i = first + get_global_id(0);
  ends[i] = end_in_block(&arrays, &medium, &how, &all, resumes, i);
#endif
}
