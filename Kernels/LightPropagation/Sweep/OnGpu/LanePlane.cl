// A plane of a lane of a sweep on GPUs, and its sides.
//
// Layout of the rays that enter or leave through the sides: [plane, counted from where rays
// start][ray][channel][SIDE_FLOATS], see SweepSides.cl.

#pragma once
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"

#define SIDE_FLOATS(plane) ((plane)->sizeU + (plane)->sizeV + 1)

// Index in the box of the k-th plane that a lane crosses.
static int plane_of(const __global SweepLane* lane, int k)
{
  const int of_axis = k % lane->planes.sizeP; // in laps round a periodic axis
  return lane->backward ? lane->planes.sizeP - 1 - of_axis : of_axis;
}
