#pragma once

#include "Distribution/BlockPartition.h"

#include <vector>

namespace tyndall
{
/// A grid's planes across an axis, spread over ranks as evenly as whole planes allow, for sweeps along it.
struct SlabsAcross
{
  /// Ranks without voxels get no planes; where there are fewer planes than others, some of these do not either. Who has
  /// voxels lower along the axis gets lower planes.
  SlabsAcross(const BlockPartition& blocks, int axis);

  int PlaceOf(int rank) const; ///< of its planes among those of all, from the lowest; -1: it has none

  BlockPartition boxes;   ///< by rank; of no voxels where one has no planes
  std::vector<int> ranks; ///< that have planes, from the lowest
};
}
