// Index of the planes that a lane crosses in a sweep on GPUs, and memory layout of the rays at the planes' sides. A
// lane is the rays that march in one sense along an axis.
//
// The power of rays that enter or leave through the sides is stored as [plane][ray][channel][SIDE_FLOATS]; planes are
// counted from where rays start. SIDE_FLOATS has one float per column of the plane for the rays that cross the face
// normal to v, one per row for those that cross the face normal to u, and one for the ray that crosses both at once.

#pragma once
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"

#define SIDE_FLOATS(plane) ((plane)->sizeU + (plane)->sizeV + 1)

// Index in the box of the k-th plane that the rays of a lane (one sense along an axis) cross, k >= 0.
static int plane_of(const __global SweepLane* lane, int k)
{
  // If k is beyond the planes of the axis, rays are in another lap around a periodic axis
  const int of_axis = k % lane->planes.sizeP;
  return lane->backward ? lane->planes.sizeP - 1 - of_axis : of_axis;
}
