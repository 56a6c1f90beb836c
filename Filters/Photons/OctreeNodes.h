#pragma once

#include "Distribution/BrickedBytes.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include "vtkType.h"

class vtkHyperTreeGrid;

namespace tyndall
{
/// The roots of the trees that show an octree: cubes of the largest level there is, or of three below the top, so that
/// they stick out of the grid little. Each rank makes those whose first voxels are in its block.
struct OctreeRoots
{
  /// @param largest  level of all nodes
  OctreeRoots(const Grid& whole, int topLevel, int largest);

  VoxelBox Of(const VoxelBox& block) const;       ///< counted in roots
  VoxelBox VoxelsOf(const VoxelBox& roots) const; ///< within the grid

  Grid grid;
  int level;
};

/// Makes some of the roots a vtkHyperTreeGrid, among the borders of all: its leaves are the octree's nodes, each with
/// its level as cell array `octree_level`; leaves wholly outside of the grid are masked. Without roots it is empty.
/// @param levels  of all voxels of these roots
/// @return the number of leaves that are not masked: the octree's nodes
vtkIdType FillWithNodes(
  const OctreeRoots& all, const VoxelBox& roots, const BrickedBytes& levels, vtkHyperTreeGrid* nodes);
}
