#pragma once

#include "LightPropagation/Sweep/SweepVolume.h"

#include "Device/Monitor.h"
#include "Lights/Lights.h"

namespace tyndall
{
/// The first-collision source: follows the light of one source from the light to where it first meets the medium, along
/// exact rays, and deposits what they lose as a sweep does. No set of directions could: a small or collimated source
/// seen through one is a handful of rays (ray effects of 100% and more).
///
/// A directional light is a beam of parallel rays, 2 x 2 a voxel. Point, spot and rectangle lights send square
/// beams, at most half a voxel wide (a rectangle's: one) where they leave the box and at least 16 across a spot's cone,
/// each with the power of its exact solid angle; a rectangle does so from 4 x 4 points. What beams on a cone's border
/// miss of the power of a light inside the box is made up for. Deposits of different beams meet in 64-bit fixed point,
/// so that the sum does not depend on their order.
///
/// Where an axis is periodic, rays that leave return on the other side; a light outside the box then shines only on
/// what it sees of the box itself, once for each period.
///
/// @param workspace  of sweeps that are not under way
/// @return what came in (for a light inside the box: all its power), what left, what still goes round a periodic axis
SweepTally DepositLamp(Device& device, const SweepVolume& volume, const Light& light,
  const std::array<bool, 3>& periodic, SweepWorkspace& workspace, const Monitor& monitor);
}
