#pragma once

#include "Distribution/BrickedBytes.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include "vtkType.h"

class vtkHyperTreeGrid;

namespace tyndall
{
/// Root cells of the vtkHyperTreeGrid that shows an octree: cubes of the octree's largest level, or of the third level
/// below the top, so that they extend little beyond the grid. Each rank builds the trees of those roots whose first
/// voxel is in its block.
struct OctreeRoots
{
  /// @param largest  largest level of all nodes
  OctreeRoots(const Grid& whole, int topLevel, int largest);

  VoxelBox Of(const VoxelBox& block) const;       ///< roots that begin in the block, counted in roots
  VoxelBox VoxelsOf(const VoxelBox& roots) const; ///< voxels of these roots that lie within the grid

  Grid grid;
  int level;
};

/// Fills a vtkHyperTreeGrid, whose coordinates are the borders of all roots, with the trees of some roots. Leaves are
/// the octree's nodes, with their level as cell array `octree_level`; leaves wholly outside the grid are masked.
/// Without roots the vtkHyperTreeGrid is empty.
/// @param roots  the roots whose trees to build
/// @param levels  octree levels of all voxels of these roots
/// @return the number of leaves that are not masked: the octree's nodes
vtkIdType FillWithNodes(
  const OctreeRoots& all, const VoxelBox& roots, const BrickedBytes& levels, vtkHyperTreeGrid* nodes);
}
