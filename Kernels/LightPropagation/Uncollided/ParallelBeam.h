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

// The same in two steps, where the grid that rays go through is not the one that the arrays are over.

/// @param volume  the grid of its layout is the one that rays go through; its deposit is not looked at
/// @param firstMoments  are to be found: along more rays
/// @param deposit  of the beam
SweepTally SweepBeam(const UncollidedVolume& volume, const Light& light, bool firstMoments, const Deposit& deposit,
  const Monitor& monitor);

/// Adds what a beam deposited to path and first moments of the volume's deposit. These are found from the powers
/// through the voxels' faces, so those that enter the voxels beside are looked at.
/// @param ofBeam  path and partial currents
/// @param beyond  of these, where the layout's grid is a block
void AddWithFirstMoments(
  const UncollidedVolume& volume, const Light& light, const Deposit& ofBeam, const BeyondFaces& beyond = {});
}
