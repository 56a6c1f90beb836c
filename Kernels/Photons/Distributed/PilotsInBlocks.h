#pragma once

#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Photons/Importance/PilotLight.h"
#include "Photons/Marching/MarchMedium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// What pilot photons are gathered in.
struct PilotBlocks
{
  Communicator& communicator;
  const BlockPartition& partition;
  const MarchMedium* through; ///< this rank's block; null: it has no voxels
  const MarchTraits& traits;  ///< of all blocks
  const MarchSettings& settings;
};

/// PilotGathering over ranks: each starts the photons that set off in its block, of those that all have alike, and what
/// they leave in cells, whole numbers, is added up. All ranks call it.
/// @return the light of the whole, bit for bit, on each
/// @throws  on every rank what PhotonMarcher::Gather throws on one of them
PilotLight GatherInBlocks(const PilotBlocks& blocks, const std::vector<Photon>& photons,
  const std::vector<std::array<int, 2>>& origins, const std::array<int, 3>& cells, const Monitor& monitor);
}
