#pragma once

#include "Device/Monitor.h"
#include "LightPropagation/Uncollided/Lamps/LampPyramids.h"
#include "LightPropagation/Uncollided/Lamps/LampShares.h"
#include "Medium/Grid.h"

#include <array>
#include <functional>

namespace tyndall
{
/// Traces the beams of a pass and adds the result to the shares.
/// @param factor  multiplies the power that the beams start with
using FollowPass = std::function<void(const Pass& pass, double factor, const Monitor& monitor)>;

/// Traces a lamp's light around periodic axes in passes (numerics.md, section 5.3): beams that are still in the box at
/// the end of a pass are replaced by fewer beams, which share their power.
/// @param shares  of the lamp over all passes so far, updated by `follow`
/// @return fraction of the lamp's power to be spread uniformly over a box that is periodic along all axes; else 0
double FollowInPasses(const Grid& grid, const std::array<bool, 3>& periodic, LampShares& shares,
  const FollowPass& follow, const Monitor& monitor);
}
