// Where a lane of a sweep for GPUs is. The host gives AROUND, as SweepOnGpu.cl has it.

#pragma once
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"

// The plane of the box that a lane crosses as its k-th.
static int plane_of(const __global SweepLane* lane, int k)
{
  const int of_axis = AROUND ? k % lane->planes.sizeP : k;
  return lane->backward ? lane->planes.sizeP - 1 - of_axis : of_axis;
}
