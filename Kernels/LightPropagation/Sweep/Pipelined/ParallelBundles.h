#pragma once

#include "LightPropagation/Sweep/SweepOperator.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Rays that march along one axis and whose directions lie in one octant: they run from one corner of the box towards
/// the opposite one. Blocks of a grid are swept along such a set one after the other, each after the blocks upwind of
/// it.
struct ParallelBundles
{
  int axis = 0;
  int way = 0;                            ///< 0 forward along the axis, 1 backward
  std::array<int, 3> signs = { 1, 1, 1 }; ///< along x, y, z: 1 upwards, -1 downwards
  std::vector<Bundle> bundles;            ///< each member has a direction for one way only
  bool goThroughEdges = false;            ///< some rays move along u and v at once

  int Rays() const; ///< rays per voxel of a plane across the axis
};

/// Divides rays into sets of parallel bundles by octant. @param mostRays  most rays per set; 0: no limit
std::vector<ParallelBundles> SortByOctant(const std::vector<AxisBundles>& rays, int mostRays);
}
