#pragma once

#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

namespace tyndall
{
/// The grid formed by a box of voxels of `whole`, at the same position in space.
inline Grid GridOfBox(const VoxelBox& box, const Grid& whole)
{
  Grid grid = whole;
  grid.size = box.size;
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.origin[axis] += box.first[axis] * whole.spacing[axis];
  }
  return grid;
}
}
