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
}
