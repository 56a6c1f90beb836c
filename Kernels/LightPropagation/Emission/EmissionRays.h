#pragma once

#include "LightPropagation/Emission/EmissionPeaks.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include "Device/Monitor.h"

namespace tyndall
{
/// Adds to a deposit the uncollided flux of a localised emission, which every voxel gathers along straight rays.
/// (Kobayashi et al. 2001, problem 1, shows the ray effects of a coarse quadrature for such an emission.)
///
/// Computes the mean over each voxel of the integral of radiance over the solid angle of the peak's bounding box
/// (numerics.md, Eq. (40)), with exact optical lengths. Points in the voxel and directions form a rank-1 lattice in
/// five dimensions. Each voxel starts with 32 to 4096 rays, more for smaller grids and smaller errors. The number is
/// doubled, up to 4096, while the two halves of a voxel's rays differ by more than `error`. If the grid is so large
/// that every voxel would start with 32, voxels far from the peak and cells of the box's faces share fans of rays
/// (EmissionFans.h).
///
/// Guarantees: the light has the symmetries of the scene, and absorbed, scattered and escaped power add up to the
/// emitted power.
///
/// Requires that no axis is periodic. Does not compute first moments of the deposit (Deposit::firstMoments): the light
/// removed in a voxel is taken as uniform over it.
///
/// @param firstChannel  channel of the peak that corresponds to the first channel of `volume`
/// @param error  accepted difference between the light of the first and the second half of a voxel's rays, relative to
///   the sum
/// @return tally with the escaped power; there is no incident power
SweepTally DepositEmission(Device& device, const SweepVolume& volume, int firstChannel, const EmissionPeak& peak,
  double error, const Monitor& monitor);
}
