// Position of a lane of a sweep on GPUs. The host defines AROUND as in SweepOnGpu.cl.

#pragma once
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"

// Index in the box of the k-th plane that a lane crosses.
static int plane_of(const __global SweepLane* lane, int k)
{
  const int of_axis = AROUND ? k % lane->planes.sizeP : k;
  return lane->backward ? lane->planes.sizeP - 1 - of_axis : of_axis;
}
