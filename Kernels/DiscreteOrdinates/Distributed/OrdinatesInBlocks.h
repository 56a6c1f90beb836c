#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "DiscreteOrdinates/OrdinatesQuality.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// The light of a medium that is spread over ranks by blocks, by discrete ordinates (DiscreteOrdinates.h): sweeps go
/// from rank to rank (UpwindSweepInBlocks.h), scattering is by voxel, and powers are sums over ranks. No rank holds
/// more than its block. Collective. The light is that of SolveDiscreteOrdinates, order by order, but for rounding.
/// Conservative only.
///
/// @param medium  of the rank's block, with the grid that partition.OwnGrid() has; looked at by nobody where that has
///   no voxels
/// @param illumination, settings  the same on all ranks
/// @param kept  as SolveDiscreteOrdinates has it: of each rank the light of its own block. It is begun from where it
///   fits on all ranks; where blocks, or anything else, have changed on one, all begin in the dark. Null on all ranks
///   or on none
/// @return the light of the rank's block; balance, face powers and convergence are of the whole. Empty arrays where the
///   block is
/// @throws InvalidInput  on every rank, where one of them has an input that SolveDiscreteOrdinates refuses, where they
///   disagree, or where blocks wait for each other
/// @throws DeviceError, Aborted  on every rank what one of them throws
LightField SolveOrdinatesInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const OrdinatesSettings& settings,
  const Monitor& monitor = {}, KeptLight* kept = nullptr);

/// AtQuality (OrdinatesQuality.h), as one rank chooses it that has the whole medium and the smallest memory of all. All
/// ranks call it, and are told the same.
/// @param memory  of this rank's device
OrdinatesSettings AtQualityInBlocks(Communicator& communicator, const BlockPartition& partition, Quality quality,
  const OrdinatesSettings& settings, const Medium& medium, const DeviceMemory& memory);
}
