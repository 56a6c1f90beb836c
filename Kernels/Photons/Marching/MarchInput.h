#pragma once

#include "Distribution/Domain.h"
#include "Medium/FilledBricks.h"
#include "Medium/Medium.h"
#include "Refraction/Index/IndexRange.h"

#include <cstdint>

namespace tyndall
{
// Checks of the medium through which photons are marched; each rank has one block of it.

/// Checks the medium of this rank's block; a rank without voxels has none to check.
/// @param levels  null if there is no octree
/// @param octree  whether any rank has octree levels
/// @return which of the medium's bricks are filled
/// @throws InvalidInput if the block's input is not valid
FilledBricks CheckMarchedMedium(
  const Domain& domain, const Medium& medium, const Field& ior, const std::uint8_t* levels, bool octree);

/// Checks that all blocks agree on the partition, on whether there is a refractive index, and on the number of
/// components of their coefficients. Collective.
/// @throws InvalidInput  on every rank, if they differ
void RequireSameMedium(const Domain& domain, const Medium& medium, const Field& ior);

/// The range of the refractive index over all blocks. Collective.
IndexRange IndexRangeOfAll(const Domain& domain, const IndexRange& own);
}
