// Definitions shared by the kernels of the diffusion system.

#pragma once
#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "Numerics/Exact.cl"

// Defines x, y, z and index i of the work-item's voxel.
#define VOXEL(count)                                                          \
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2); \
  if (x >= (count)[0] || y >= (count)[1] || z >= (count)[2])                  \
  {                                                                           \
    return;                                                                   \
  }                                                                           \
  const int i = (z * (count)[1] + y) * (count)[0] + x;

#define IS_OUTERMOST(layout, at)                                                    \
  ((!(layout).periodic[0] && ((at)[0] == 0 || (at)[0] == (layout).size[0] - 1)) ||  \
    (!(layout).periodic[1] && ((at)[1] == 0 || (at)[1] == (layout).size[1] - 1)) || \
    (!(layout).periodic[2] && ((at)[2] == 0 || (at)[2] == (layout).size[2] - 1)))

// Neighbours across all faces, wrapped around every axis; at the box's boundary the conductance is zero.
static void find_neighbours(const int* size, int x, int y, int z, int i, int* next)
{
  const int row = size[0];
  const int plane = size[0] * size[1];
  next[0] = i + (x > 0 ? -1 : size[0] - 1);
  next[1] = i + (x < size[0] - 1 ? 1 : 1 - size[0]);
  next[2] = i + (y > 0 ? -row : (size[1] - 1) * row);
  next[3] = i + (y < size[1] - 1 ? row : (1 - size[1]) * row);
  next[4] = i + (z > 0 ? -plane : (size[2] - 1) * plane);
  next[5] = i + (z < size[2] - 1 ? plane : (1 - size[2]) * plane);
}
