#pragma once

#include "Distribution/BlockPartition.h"
#include "LightPropagation/Sweep/Pipelined/ParallelBundles.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Set of faces through which rays pass from one block into another.
struct BlockContact
{
  enum Kind
  {
    Along,  ///< through faces across the marching axis, at the end of a plane
    AsideU, ///< through faces across u or v, within a plane
    AsideV,
    Edge ///< by a move along u and v at once
  };
  int from = 0, to = 0;
  Kind kind = Along;
  VoxelBox cells;      ///< voxels that the rays come from, indexed in the whole grid
  bool around = false; ///< the rays wrap around a periodic axis
};

/// All contacts from one block to another, or to itself around periodic axes: none or one of most kinds, in the order
/// of Kind.
std::vector<BlockContact> ContactsBetween(const BlockPartition& partition, const ParallelBundles& rays, int from,
  int to, const std::array<bool, 3>& periodic = {});
}
