// Samples have a border of one voxel that repeats the outermost ones. A work-item's place among them, and the voxel
// that stands there.

#pragma once
#include "Medium/BrickShared.h"

inline int padded_index(int4 size)
{
  return ((int)get_global_id(2) * (size.y + 2) + (int)get_global_id(1)) * (size.x + 2) + (int)get_global_id(0);
}
inline int voxel_index(int4 size)
{
  const int i = clamp((int)get_global_id(0) - 1, 0, size.x - 1);
  const int j = clamp((int)get_global_id(1) - 1, 0, size.y - 1);
  const int k = clamp((int)get_global_id(2) - 1, 0, size.z - 1);
  return (k * size.y + j) * size.x + i;
}
// Whether rays have to look at voxels of this work-group, which is PackedAlong voxels of a row.
// @param seen  of such groups in 8 x 8 rows, which are one brick across (PackedSamples.cxx)
inline int is_seen(__global const uchar* seen, int4 size)
{
  const int j = clamp((int)get_global_id(1) - 1, 0, size.y - 1) >> BrickBits;
  const int k = clamp((int)get_global_id(2) - 1, 0, size.z - 1) >> BrickBits;
  const int ny = (size.y + BrickEdge - 1) / BrickEdge;
  return seen[(k * ny + j) * (int)get_num_groups(0) + (int)get_group_id(0)];
}
