#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// The light of a medium that is spread over ranks by blocks, by light propagation maps as published
/// (ParallelPropagation.h): that of SolveParallel, to rounding, with as many orders. All ranks call it together.
///
/// Sweeps go through whole planes of the grid (SweepInSlabs.h), which ranks get from those who have the blocks; what is
/// collected goes back into these. Beside its block a rank holds 1/ranks of the planes across each axis, maps of a
/// plane of a batch of directions, and where faces reflect or face power is asked for the cells of the box's faces.
///
/// @param medium  of the rank's block, with the grid that partition.OwnGrid() has; looked at by nobody where that has
///   no voxels
/// @param illumination, settings  the same on all ranks; of lamps distant ones alone shine, as leftOut says
/// @param kept  as SolveParallel has it: of each rank the light of its own block. It is begun from where it fits on all
///   ranks, else all begin in the dark. Null on all ranks or on none
/// @return the light of the rank's block; balance, face powers and convergence are of the whole. Empty arrays where the
///   block is
/// @throws InvalidInput  on every rank, where one of them has an input that Check() refuses or a phase function that
///   CheckPublishedPhase does, or where they disagree
/// @throws DeviceError, Aborted  on every rank what one of them throws
LightField SolvePublishedInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings,
  const Monitor& monitor = {}, KeptLight* kept = nullptr);

/// The same by the sequential algorithm: the light of SolveSequential, to rounding, with as many orders. A ray is
/// followed through a rank's planes, then through those of the next (SlabRaysInTurn.h); ranks work at once on different
/// directions, each on one core. It needs no device, keeps no light, and throws no DeviceError.
LightField SolveSequentialInBlocks(Communicator& communicator, const BlockPartition& partition, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor = {});
}
