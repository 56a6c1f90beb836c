#pragma once

#include "SweepVolume.h"

#include "../Device/Monitor.h"
#include "../Lights/Lights.h"

namespace tyndall
{
/// The first-collision source: follows the light of one source from the light to where it first meets the medium, along
/// exact rays, and deposits what they lose as a sweep does. No set of directions could: a small or collimated source seen
/// through one is a handful of rays (ray effects of 100% and more).
///
/// A directional light is a beam of parallel rays, 2 x 2 a voxel. Point, spot and rectangle lights send rays through
/// the box's faces towards which they shine, 2 x 2 a voxel face, each with the power of the exact solid angle of its part
/// of the face; a rectangle does so from 4 x 4 points. Deposits of different rays meet in 64-bit fixed point, so that the sum
/// does not depend on their order.
///
/// Where an axis is periodic, rays that leave return on the other side; a light outside the box then shines only on
/// what it sees of the box itself, once for each period.
///
/// @param workspace  of sweeps that are not under way
/// @return what came in (for a light inside the box: all its power), what left, what still goes round a periodic axis
SweepTally DepositLight(Device& device, const SweepVolume& volume, const Light& light,
  const std::array<bool, 3>& periodic, SweepWorkspace& workspace, const Monitor& monitor);
}
