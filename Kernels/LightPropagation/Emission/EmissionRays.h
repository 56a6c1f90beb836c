#pragma once

#include "LightPropagation/Emission/EmissionPeaks.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include "Device/Monitor.h"

namespace tyndall
{
/// The first-collision source of what a medium emits itself: the unscattered light of a peak, gathered along straight
/// rays by every voxel (Kobayashi et al. 2001, problem 1, shows what a coarse set of directions makes of it).
///
/// The mean over a voxel of the integral of radiance over the solid angle of the box around the peak (numerics.md,
/// Eq. (40)), with exact optical lengths: points and directions are a lattice in five dimensions (of rank 1), 32 to
/// 4096 rays a voxel at first, the more the smaller the grid and the error asked for. Where two halves of them differ
/// by more than that, twice as many, up to 4096. Where the grid is so large that all would begin with 32, voxels far
/// from the peak and cells of the box's faces share fans of rays (EmissionFans.h).
///
/// Promises: the light has the symmetries of the scene, and what is taken and what leaves are the power emitted.
///
/// Needs axes that are not periodic. Finds no first moments of the deposit (Deposit.h): light is taken as lost evenly
/// in each voxel.
///
/// @param firstChannel  of the peak's three, that is the volume's first
/// @param error  difference of two halves of a voxel's rays, to their sum, that will do
/// @return what left; nothing comes in
SweepTally DepositEmission(Device& device, const SweepVolume& volume, int firstChannel, const EmissionPeak& peak,
  double error, const Monitor& monitor);
}
