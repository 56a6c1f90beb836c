#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/Medium.h"
#include "Photons/Distributed/PhotonRounds.h"
#include "Photons/Photons.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Marches photons through a medium that is spread over ranks by blocks, as PhotonMarcher marches them through the
/// whole. All ranks call it together.
///
/// A photon that leaves a block is handed, as it is, to the rank whose block it enters, and goes on there
/// (numerics.md, section 12.6), with the random numbers that it has drawn where it is scattered: its way does not depend
/// on the blocks, and what voxels gain is in fixed point. The light is that of PhotonMarcher, bit for bit, whatever the
/// number of ranks; tallies of scattered light, which are sums of floats, to 1e-12. No rank holds more of the medium than
/// its block and, of the refractive index, some voxels round it.
///
/// @param medium  of the rank's block, with the grid that partition.OwnGrid() has; looked at by nobody where that has
///   no voxels
/// @param ior     of the block's voxels, one component; null values: 1
/// @param settings, photons  the same on all ranks. `byBricks` does not matter: light is kept voxel by voxel
/// @param traffic  of this rank, if it is asked for
/// @return arrays of the rank's block, none where that is empty; balance, face powers and all counts are of the whole
/// @throws InvalidInput  on every rank, where one of them has an input that PhotonMarcher refuses, where they disagree,
///   or where something is asked for that is not carried from rank to rank: names it
/// @throws DeviceError, Aborted  on every rank what one of them throws
PhotonLight MarchInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Field& ior, const MarchSettings& settings, const std::vector<Photon>& photons,
  const Monitor& monitor = {}, PhotonTraffic* traffic = nullptr);

/// What is asked for that keeps MarchInBlocks from it, in words for an error; empty: nothing does.
/// @param octree  whether paths are to go by the steps of an octree
std::string NotInBlocks(const MarchSettings& settings, bool octree);
}
