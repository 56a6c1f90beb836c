#pragma once

#include "Distribution/BrickedBytes.h"
#include "Medium/VoxelBox.h"
#include "Refraction/Octree/RefractionOctree.h"

#include "vtkType.h"

class vtkHyperTreeGrid;

namespace tyndall
{
/// Make the octree a vtkHyperTreeGrid, to look at: its leaves are the octree's nodes, each with its level as cell array
/// `octree_level`. The roots are cubes of the largest level there is, or of three below the top, so that they stick out
/// of the grid little; leaves wholly outside of the grid are masked.
/// @return the number of leaves that are not masked: the octree's nodes
vtkIdType FillWithNodes(const Grid& grid, const Octree& octree, vtkHyperTreeGrid* nodes);

/// The roots of such trees, of which each rank makes those whose first voxels are in its block.
struct OctreeRoots
{
  /// @param largest  level of all nodes
  OctreeRoots(const Grid& whole, int topLevel, int largest);

  VoxelBox Of(const VoxelBox& block) const;       ///< counted in roots
  VoxelBox VoxelsOf(const VoxelBox& roots) const; ///< within the grid

  Grid grid;
  int level;
};

/// The same of some of the roots, among the borders of all; of none without any.
/// @param levels  of all voxels of these roots
vtkIdType FillWithNodes(
  const OctreeRoots& all, const VoxelBox& roots, const BrickedBytes& levels, vtkHyperTreeGrid* nodes);
}
