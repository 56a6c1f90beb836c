#pragma once

#include "Distribution/BrickedBytes.h"
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
/// The same of levels in bricks.
vtkIdType FillWithNodes(const Grid& grid, int topLevel, const BrickedBytes& levels, vtkHyperTreeGrid* nodes);
}
