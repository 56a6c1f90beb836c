#pragma once

#include "LightPropagation/Uncollided/UncollidedSource.h"
#include "Lights/Lights.h"

namespace tyndall
{
/// Computes the uncollided flux of a directional light by sweeps along its one direction, with 2 x 2 parallel rays a
/// voxel (numerics.md, section 5.3); with 8 x 8 if the deposit has first moments.
///
/// @return incident power, escaped power, and the power still in flight around periodic axes
SweepTally DepositBeam(const UncollidedVolume& volume, const Light& light, const Monitor& monitor);

// DepositBeam() in two steps, for arrays that cover only a block of the grid that the rays cross.

/// @param volume  its deposit is not used
/// @param firstMoments  whether AddWithFirstMoments() follows, which needs more rays
/// @param deposit  receives the light of the beam
SweepTally SweepBeam(const UncollidedVolume& volume, const Light& light, bool firstMoments, const Deposit& deposit,
  const Monitor& monitor);

/// Adds a beam's deposit to the path and first moments of the volume's deposit. First moments are computed from the
/// powers through each voxel's faces, including those that enter the neighbouring voxels.
/// @param ofBeam  path and partial currents of the beam
/// @param beyond  partial currents of the beam beyond the block's faces, if the layout's grid is a block
void AddWithFirstMoments(
  const UncollidedVolume& volume, const Light& light, const Deposit& ofBeam, const BeyondFaces& beyond = {});
}
