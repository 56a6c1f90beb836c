#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Field.h"
#include "Medium/Medium.h"

#include <string>

namespace tyndall
{
/// The steady light of a lattice (LatticeBoltzmann.h) in a medium that is spread over ranks by blocks. Each rank holds
/// its block with two layers of its neighbours' voxels; lines of links go on from block to block, and diffusion, which
/// preconditions, is solved on cells of several voxels on the first rank (numerics.md, section 10 c). All ranks call it
/// together.
///
/// The light is that of SolveLatticeBoltzmann to the tolerance, with its refraction, colours, faces' albedo, first
/// moments of lamps' light and net flux, and does not depend on the number of ranks, but for rounding.
///
/// @param medium, ior  of the rank's block, with the grid that partition.OwnGrid() has; looked at by nobody where that
///   has no voxels
/// @param illumination, settings  the same on all ranks
/// @return the light of the rank's block; balance, face powers and convergence are of the whole. Empty arrays where the
///   block is
/// @throws InvalidInput  on every rank, where one of them has an input that SolveLatticeBoltzmann refuses, where they
///   disagree, where blocks wait for each other, or where the scene has something that is not carried: names it
/// @throws DeviceError, Aborted  on every rank what one of them throws
LightField SolveLatticeInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Field& ior, const Illumination& illumination, const LatticeSettings& settings,
  const Monitor& monitor = {});

/// What of a scene keeps SolveLatticeInBlocks from it, in words for an error; empty: nothing does.
std::string NotInBlocks(const Illumination& illumination, const LatticeSettings& settings);
}
