#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "Light/Quality.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <string>

namespace tyndall
{
/// The light of a medium that is spread over ranks by blocks, by light propagation maps
/// (ConservativePropagation.h): sweeps go from rank to rank (SweepInBlocks.h), what counts power and when orders
/// end is the same on all. No rank holds more than its block, a layer around it where the source is linear, values by
/// cells of several voxels, and where faces reflect or face power is asked for those of the cells of the box's faces.
/// All ranks call it together.
///
/// Orders are added up as ChooseIterationScheme (OrdersOverRanks.h) has it: one by one; where voxels are thin
/// and light is
/// scattered many times each with what diffusion on cells says of the rest (CellsOverRanks.h); where voxels are thicker
/// by their balance (AccelerationInBlocks.h), both with the source that the settings ask for. One by one thick voxels
/// shine by octant, as in the whole (OctantSources.h). Cells are for isotropic scattering in an open box without faces
/// that reflect.
///
/// Carried are light that comes in through the box's faces, from the sky and the environment, of all kinds of lights,
/// and emission; scattering in angular moments; light that faces give back and that goes round periodic axes. The light
/// is that of SolveConservative with emissionError 0, and where voxels are balanced uncollidedDirections 0 for -1 (else
/// -1 chooses as there): to rounding where neither is accelerated, else to the tolerance. It does not depend on the
/// number of ranks, but for rounding.
///
/// @param medium  of the rank's block, with the grid that partition.OwnGrid() has; looked at by nobody where that has
///   no voxels
/// @param illumination, settings  the same on all ranks, but for memoryBudget: what of this rank's arrays does not fit
///   that lies in host memory, and is read from there (BudgetAskedFor in SolveMemory.h)
/// @param kept  as SolveConservative has it: of each rank the light of its own block. It is begun from where it fits on
///   all ranks, by as many sweeps as the whole takes; where blocks, or anything else, have changed on one, all begin in
///   the dark. Null on all ranks or on none
/// @return the light of the rank's block; balance, face powers and convergence are of the whole. Empty arrays where the
///   block is
/// @throws InvalidInput  on every rank, where one of them has an input that Check() refuses, where they disagree, or
///   where the scene has something that is not carried from rank to rank: names it
/// @throws DeviceError, Aborted  on every rank what one of them throws
LightField SolveInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings,
  const Monitor& monitor = {}, KeptLight* kept = nullptr);

/// What SolveInBlocks checks first. All ranks call it.
/// @throws InvalidInput  as SolveInBlocks
void CheckBlocks(Communicator& communicator, const BlockPartition& partition, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings);

/// Whether SolveInBlocks would add up orders by the balance of voxels. All ranks call it, and are told the same.
/// @throws as SolveInBlocks
bool BalancesVoxels(Device& device, Communicator& communicator, const BlockPartition& partition, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings);

/// What of settings keeps SolveInBlocks from it, in words for an error; empty: nothing does.
std::string NotInBlocks(const PropagationSettings& settings);

/// AtQuality (PropagationQuality.h), as of the whole medium. All ranks call it.
PropagationSettings AtQualityInBlocks(Communicator& communicator, const BlockPartition& partition, Quality quality,
  const PropagationSettings& settings, const Medium& medium, const Illumination& illumination);

/// What of a scene that SolveInBlocks can solve SolveConservative solves more exactly or much sooner, in words that
/// follow "the whole is better for"; empty: nothing, the light is the same to the tolerance. All ranks call it, and
/// are told the same.
/// @throws as SolveInBlocks
std::string ReasonNotToDecompose(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);
}
