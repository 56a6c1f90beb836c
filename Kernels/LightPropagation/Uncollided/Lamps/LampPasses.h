#pragma once

#include "Device/Monitor.h"
#include "LightPropagation/Uncollided/Lamps/LampPyramids.h"
#include "LightPropagation/Uncollided/Lamps/LampShares.h"
#include "Medium/Grid.h"

#include <array>
#include <functional>

namespace tyndall
{
/// Follows beams of a pass, and counts in the shares what becomes of them.
/// @param factor  of the power that they set off with
using FollowPass = std::function<void(const Pass& pass, double factor, const Monitor& monitor)>;

/// A lamp's light round periodic axes in passes (numerics.md, section 5.3): beams that are still in the box where one
/// pass ends go on as others, fewer, that share its power.
/// @param shares  of the whole lamp, as `follow` leaves them
/// @return of its power, what is to be spread evenly over a box without faces
double FollowInPasses(const Grid& grid, const std::array<bool, 3>& periodic, LampShares& shares,
  const FollowPass& follow, const Monitor& monitor);
}
