#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Reconstruction/PhotonReconstruction.h"

namespace tyndall
{
/// Reconstruct of light that is spread over ranks by blocks: the light of the whole, to rounding, whatever the blocks.
/// All ranks call it.
///
/// Each rank has its block and 32 voxels round it (16 by the estimators other than the conservative one), of which it
/// makes two levels of the pyramid; levels above, a 64th of the grid, each has of all (numerics.md, section 13.2).
///
/// @param partition  as many blocks as ranks; must stay
/// @param light      of the rank's block, with the grid that partition.OwnGrid() has; looked at by nobody where that
///   has no voxels
/// @return arrays of the block; bias and leftOut are of the whole
/// @throws InvalidInput, DeviceError, Aborted  on every rank what Reconstruct throws on one of them, and where they
///   disagree
ReconstructedLight ReconstructInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const NoisyLight& light, const ReconstructionSettings& settings = {}, const Monitor& monitor = {});
}
