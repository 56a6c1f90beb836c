#pragma once

#include "Distribution/BlockPartition.h"
#include "LightPropagation/Sweep/Pipelined/ParallelBundles.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Where rays go from one block into another.
struct BlockContact
{
  enum Kind
  {
    Along,  ///< through the faces across the axis that they march along, at the end of a plane
    AsideU, ///< through those across u or v, within one
    AsideV,
    Edge ///< by a move along both at once
  };
  int from = 0, to = 0;
  Kind kind = Along;
  VoxelBox cells;      ///< that they come from, in voxels of the whole grid
  bool around = false; ///< past the end of a periodic axis, from the other side
};

/// All contacts of one block with another, or round periodic axes with itself, none or one of most kinds, in the order
/// of these.
std::vector<BlockContact> ContactsBetween(const BlockPartition& partition, const ParallelBundles& rays, int from,
  int to, const std::array<bool, 3>& periodic = {});
}
