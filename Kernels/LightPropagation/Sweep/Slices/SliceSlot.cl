// Moves pointers to the slot that a launch works in, for streamed volumes (SliceStream.h).

#pragma once
#include "LightPropagation/Sweep/OnCpu/SweepLayout.cl"

// For streamed volumes, slots hold slices: the steps in PlaneInfo are those of a slot, slot.x is the slot's number, and
// slot.y is the index in the box of the slot's first plane.
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
