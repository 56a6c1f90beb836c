#pragma once

#include "LightPropagation/Sweep/SweepOperator.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Rays that march along one axis and go the same way along all three: from one corner of the box towards the opposite
/// one. Blocks of a grid are swept by these one after the other, each when those upwind of it are.
struct ParallelBundles
{
  int axis = 0;
  int way = 0;                            ///< 0 forward along the axis, 1 backward
  std::array<int, 3> signs = { 1, 1, 1 }; ///< along x, y, z: 1 upwards, -1 downwards
  std::vector<Bundle> bundles;            ///< members have a direction one way alone
  bool goThroughEdges = false;            ///< some move both ways aside at once

  int Rays() const; ///< a voxel of the plane across the axis
};

/// @param mostRays  of one part; 0: as many as there are
std::vector<ParallelBundles> SortByOctant(const std::vector<AxisBundles>& rays, int mostRays);
}
