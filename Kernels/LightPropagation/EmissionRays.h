#pragma once

#include "EmissionPeaks.h"
#include "SweepVolume.h"

#include "../Device/Monitor.h"

namespace tyndall
{
/// The first-collision source of what a medium emits itself: the unscattered light of a peak, gathered along straight rays by every
/// voxel (Kobayashi et al. 2001, problem 1, shows what a coarse set of directions makes of it).
///
/// Near the peak (three voxels around it), sweeps as for scattered light, of that box alone, with 2400 directions and 2 x 2
/// rays a voxel: it is seen as it is, and absorbs its own light. Beyond, the mean over a voxel of
///   integral of q exp(-tau) / r^2 dV  over the peak's box
/// with exact optical lengths tau through the voxels: between 4 x 4 x 4 parts of the box, by Gauss's rule, and Gauss's points of the
/// voxel in turn; where two halves of these rays differ, 8 x 8 x 8 parts. What a part loses in the peak's box is looked up in
/// a table by direction, made from the exact lengths of lines through it. A factor makes all of it the power that leaves the near
/// box; it is the method's own error (0.4% for Kobayashi's problem).
///
/// No axis may be periodic. Voxels' nearness (SweepVolume) is not told: their light is taken as lost evenly.
///
/// @param firstChannel  of the peak's three, that is the volume's first
/// @return what left; nothing comes in
SweepTally DepositEmission(
  Device& device, const SweepVolume& volume, int firstChannel, const EmissionPeak& peak, const Monitor& monitor);
}
