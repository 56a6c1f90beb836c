#pragma once

#include "EmissionPeaks.h"
#include "SweepVolume.h"

#include "../Device/Monitor.h"

namespace tyndall
{
/// The first-collision source of what a medium emits itself: follows the unscattered light of a peak and deposits what it
/// loses (Kobayashi et al. 2001, problem 1, shows what a coarse set of directions makes of it).
///
/// Near the peak, sweeps as for scattered light, of that box alone, with ten thousand directions and 4 x 4 rays a voxel: the peak is
/// seen as it is, and absorbs its own light. Beyond, square beams (see LampBeams.cl) from the surface of the peak's box, from
/// Gauss's points, 4 x 4 and further out 2 x 2 a face; each has the radiance that the part of the face around it
/// has that way. They bring to the near box's border the power that leaves it there.
///
/// @param firstChannel  of the peak's three, that is the volume's first
/// @return what left and what still goes round a periodic axis; nothing comes in
SweepTally DepositEmission(Device& device, const SweepVolume& volume, int firstChannel, const EmissionPeak& peak,
  const std::array<bool, 3>& periodic, const Monitor& monitor);
}
