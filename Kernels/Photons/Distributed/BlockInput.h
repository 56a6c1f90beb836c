#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/Medium.h"
#include "Refraction/Index/IndexRange.h"

#include <cstdint>

namespace tyndall
{
// What photons are marched through, of which each of several ranks has a block.

/// A rank's block; none where there are fewer blocks than ranks, which CheckMarchedBlock refuses.
VoxelBox BlockOf(const BlockPartition& partition, int rank);

/// What is given of a rank's block; nothing but the partition is looked at where it has no voxels.
/// @param levels  null: there is no octree
/// @param octree  whether any rank has levels
/// @throws InvalidInput where there is not a block for each rank, or the block's input is not right
void CheckMarchedBlock(const Communicator& communicator, const BlockPartition& partition, const Medium& medium,
  const Field& ior, const std::uint8_t* levels, bool octree);

/// What all ranks' blocks must have alike: the partition, whether they have a refractive index, and the components of
/// their coefficients. All ranks call it.
/// @throws InvalidInput  on each, where they differ
void RequireSameInput(
  Communicator& communicator, const BlockPartition& partition, const Medium& medium, const Field& ior);

/// All ranks call it. @param own  that of a rank which has no voxels does not count
IndexRange IndexRangeOfAll(Communicator& communicator, bool has, const IndexRange& own);
}
