#pragma once

#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

namespace tyndall
{
/// A box of a grid's voxels as a grid by itself, where it lies.
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
