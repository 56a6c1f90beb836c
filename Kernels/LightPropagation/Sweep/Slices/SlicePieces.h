#pragma once

#include "LightPropagation/Sweep/SweepPlan.h"

#include <vector>

namespace tyndall
{
/// Planes of the box that a unit crosses in one launch, in one slot.
struct SlicePiece
{
  cl_int2 range = { { 0, 0 } }; ///< as in SweepPlan::schedule
  int begin = 0, end = 0;       ///< planes of the box; none: the unit rests
};

/// A sweep's launches cut into shorter ones, [launch][unit], whose units need no more than a slot each of the volume.
/// Units that are in work side by side, and the order in which planes are added to, stay as they were: light is the
/// same, bit for bit.
/// @param schedule  [launch][unit] planes from, to
/// @param thickness  planes that a slot holds
/// @param aligned  pieces are to end at multiples of it, where slabs do not end before; 1: wherever they do
std::vector<std::vector<SlicePiece>> CutIntoPieces(
  const SweepPlan& plan, const std::vector<cl_int2>& schedule, int thickness, int aligned);

/// Planes of `first` and `second` that lie in the same `aligned` planes.
bool Meet(const SlicePiece& first, const SlicePiece& second, int aligned);
}
