#pragma once

#include "Distribution/Domain.h"
#include "Medium/FilledBricks.h"
#include "Medium/Medium.h"
#include "Refraction/Index/IndexRange.h"

#include <cstdint>

namespace tyndall
{
// What photons are marched through, of which each rank has a block.

/// Checks the medium of a rank's block, which a rank without voxels does not have.
/// @param levels  null: there is no octree
/// @param octree  whether any rank has levels
/// @return the medium's bricks
/// @throws InvalidInput where the block's input is not valid
FilledBricks CheckMarchedMedium(
  const Domain& domain, const Medium& medium, const Field& ior, const std::uint8_t* levels, bool octree);

/// Compares what blocks must have alike: the partition, whether they have a refractive index, and the components of
/// their coefficients. Collective.
/// @throws InvalidInput  on each rank, where they differ
void RequireSameMedium(const Domain& domain, const Medium& medium, const Field& ior);

/// The range of the index in all blocks. Collective.
IndexRange IndexRangeOfAll(const Domain& domain, const IndexRange& own);
}
