#pragma once

#include "Device/Monitor.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "Lights/Lights.h"

namespace tyndall
{
/// Follows the light of one point, spot or rectangle lamp to where it first meets the medium, along exact rays, and
/// deposits what they lose as a sweep does (numerics.md, sections 5.4 and 5.5). A set of directions would make a few
/// rays of it (ray effects of 100% and more).
///
/// Lamps send square beams, at most half a voxel wide where they leave the box and at least 16 across a spot's cone,
/// each with the power of its solid angle, Eq. (33). A rectangle is taken in parts, each for the voxels that are far
/// enough away from it, with beams a voxel wide or more; each voxel's path is then scaled to be exact in vacuum, Eq.
/// (34a).
/// Deposits of different beams meet in 64-bit fixed point, Eq. (35), so that the sum does not depend on their order.
/// All power of a lamp inside the box is followed.
///
/// Where an axis is periodic, rays that leave return on the other side, in passes with fewer beams the farther they go,
/// until 0.05% of the power is left (LampPyramids.h); a light outside the box then shines only on
/// what it sees of the box itself, once for each period.
///
/// @return what came in (for a light inside the box: all its power), what left, what still goes round a periodic axis
SweepTally DepositLamp(Device& device, const SweepVolume& volume, const Light& light,
  const std::array<bool, 3>& periodic, const Monitor& monitor);
}
