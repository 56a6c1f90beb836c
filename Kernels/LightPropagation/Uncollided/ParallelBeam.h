#pragma once

#include "LightPropagation/Uncollided/UncollidedSource.h"
#include "Lights/Lights.h"

namespace tyndall
{
/// Follows the parallel rays of a directional light, 2 x 2 a voxel, to where they first meet the medium (numerics.md,
/// section 5.3), by sweeps of that one direction.
///
/// @return what came in, what left, what still goes round a periodic axis
SweepTally DepositBeam(const UncollidedVolume& volume, const Light& light, const Monitor& monitor);

// Its two steps where first moments are asked for, for those who have partial currents of the beam from other ranks
// between them.

/// Follows the rays, 2 x 2 or finely 8 x 8 a voxel, and adds to path, flux and partial currents of a deposit.
/// @param volume  its own deposit is not looked at
SweepTally SweepBeam(
  const UncollidedVolume& volume, const Deposit& ofBeam, const Light& light, bool finely, const Monitor& monitor);

/// Adds what a beam alone deposited to the volume's deposit, with its first moments, which are found from the powers
/// through the voxels' faces. Moments of the last voxels along the beam take it that the box ends there.
/// @param ofBeam  path and partial currents
void AddWithFirstMoments(const UncollidedVolume& volume, const Light& light, const Deposit& ofBeam);
}
