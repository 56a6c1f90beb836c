#pragma once

#include "LightPropagation/Sweep/SweepPlan.h"

#include <vector>

namespace tyndall
{
/// Planes of the box that one unit crosses in one launch, all of them in one slot.
struct SlicePiece
{
  cl_int2 range = { { 0, 0 } }; ///< as in SweepPlan::schedule
  int begin = 0, end = 0;       ///< planes of the box, [begin, end); empty: the unit is idle in this launch
};

/// Cuts a sweep's launches into shorter ones, [launch][unit], so that in each launch a unit needs at most one slot of
/// the volume. Which units run concurrently and the order of additions to each plane do not change: results are
/// identical bit for bit.
/// @param schedule  [launch][unit], planes from, to
/// @param thickness  planes per slot
/// @param aligned  pieces end at multiples of this number of planes or at the end of a slab; 1: anywhere
std::vector<std::vector<SlicePiece>> CutIntoPieces(
  const SweepPlan& plan, const std::vector<cl_int2>& schedule, int thickness, int aligned);

/// Whether `first` and `second` contain planes of the same group of `aligned` planes.
bool Meet(const SlicePiece& first, const SlicePiece& second, int aligned);
}
