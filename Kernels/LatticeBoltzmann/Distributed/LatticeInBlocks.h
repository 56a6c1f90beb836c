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
#include "Photons/Photons.h"

#include <string>
#include <vector>

namespace tyndall
{
/// The steady light of a lattice (LatticeBoltzmann.h) in a medium that is spread over ranks by blocks. Each rank holds
/// its block with two layers of its neighbours' voxels; lines of links go on from block to block, and diffusion, which
/// preconditions, is solved on cells of several voxels on the first rank (numerics.md, section 10 c). All ranks call it
/// together.
///
/// The light is that of SolveLatticeBoltzmann to the tolerance, with its refraction, colours, faces' albedo, periodic
/// axes, first moments of lamps' light or of light that is given, and net flux. It does not depend on the number of
/// ranks, but for rounding. Steps are not taken over ranks (NotInBlocks, LatticeSettings.h).
///
/// @param medium, ior  of the rank's block, with the grid that partition.OwnGrid() has; looked at by nobody where that
///   has no voxels
/// @param illumination, settings  the same on all ranks
/// @return the light of the rank's block; balance, face powers and convergence are of the whole. Empty arrays where the
///   block is
/// @throws InvalidInput  on every rank, where one of them has an input that SolveLatticeBoltzmann refuses, where they
///   disagree, or where blocks wait for each other
/// @throws DeviceError, Aborted  on every rank what one of them throws
LightField SolveLatticeInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Field& ior, const Illumination& illumination, const LatticeSettings& settings,
  const Monitor& monitor = {});

/// The same of the light of photons, as SolveLatticeBoltzmann has it of the whole: they march to their ends, handed on
/// from rank to rank (PhotonMarcherInBlocks), before their light diffuses.
/// @param share  of this rank: all photons are those of rank 0, then those of rank 1, and so on
/// @throws InvalidInput  also where an axis is periodic, or what PhotonMarcherInBlocks says
LightField SolveLatticeInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Field& ior, const std::vector<Photon>& share, const Illumination& illumination,
  const LatticeSettings& settings, const Monitor& monitor = {});
}
