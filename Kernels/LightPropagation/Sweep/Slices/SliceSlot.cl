// The slot a launch works in, where volumes are streamed (SliceStream.h).

#pragma once
#include "LightPropagation/Sweep/OnCpu/SweepLayout.cl"

// Of volumes that are streamed there are slices in slots: the steps of PlaneInfo are a slot's, and
// plane `slot.y` of the box is the first one there.
static void go_to_slot(SweepInfo* info, int2 slot, const __global float** sigma, const __global float** source,
  __global float** path, __global float** lost, __global float** flux, __global float** currents,
  const __global float** octants)
{
  info->planes.firstP = -slot.y;
  const ulong voxels = slot.x * info->stride * CHANNELS;
  *sigma += slot.x * info->stride;
  *source += slot.x * info->sourceSlot;
  *path += slot.x * info->pathSlot;
  *lost += slot.x * info->pathSlot;
  *flux += 3 * voxels;
  *currents += 6 * voxels;
  *octants += 8 * voxels;
}
