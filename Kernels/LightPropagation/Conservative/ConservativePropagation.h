#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "Light/Quality.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <string>

namespace tyndall
{
/// Light propagation maps with the energy kept: the method of Fattal (2009) and Gruson et al. (2012), with
///  - conservative deposit: what a ray loses, its voxel gains (numerics.md, Eqs. (23) to (27)); no division by sigma_t;
///  - FittedDirections;
///  - lights, and what is small and bright in environment and emission, as a first-collision source along exact rays;
///  - what else comes in from outside along more directions until it is first scattered, if uncollidedDirections are
///    given;
///  - source iteration, or diffusion acceleration where light is scattered many times (numerics.md, sections 6, 7);
///  - propagation and collection in one: memory is some five arrays (sigma_t, sigma_s, source, path, fluence) and the
///    maps.
///
/// A medium with g other than 0 is solved in angular moments up to a degree, settings.angularDegree, and what its phase
/// function scatters beyond them goes straight on (delta-M, numerics.md, section 2.2); leftOut says so.
///
/// Several ranks each solve their block (numerics.md, section 4.9): sweeps are pipelined from rank to rank
/// (SweepInBlocks.h), and all that is decided or counted is so for the whole domain, so that the light is that of a
/// serial solve, to rounding or, accelerated, to the tolerance. A rank holds its block, a halo of one voxel where the
/// source is linear, and values by cells of the box's faces where these reflect or face power is asked for. Not over
/// ranks: exact rays to small bright emission, DSA on cells round periodic axes, layers in the cosine alone
/// (ReasonNotToDecompose).
///
/// @param domain  of the grid. Collective: illumination and settings are the same on all ranks, but for memoryBudget
/// @param medium  of this rank's block; of a block without voxels only the grid is read
/// @param kept  the light of the last solve is the first guess of this one, and the light of this one is left there
/// (KeptLight.h); null, on all ranks: begins in the dark, and
/// keeps nothing
/// @return the light of this rank's block; balance, face powers and convergence are of the whole domain
/// @throws InvalidInput  what Check(domain, ...) says (SceneChecks.h)
/// @throws DeviceError  if the buffers do not fit
/// @throws Aborted  when the monitor says so
LightField SolveConservative(Device& device, const Domain& domain, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor = {},
  KeptLight* kept = nullptr);
/// On a serial domain.
inline LightField SolveConservative(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor = {}, KeptLight* kept = nullptr)
{
  return SolveConservative(device, Domain(medium.grid), medium, illumination, settings, monitor, kept);
}

/// Why the serial solver would be more accurate or much faster for this scene, in words that follow "the whole is
/// better for"; empty if it would not. Collective. @throws as SolveConservative
std::string ReasonNotToDecompose(Device& device, const Domain& domain, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings);

/// AtQuality (PropagationQuality.h) of the medium of all ranks. Collective.
PropagationSettings AtQuality(const Domain& domain, Quality quality, const PropagationSettings& settings,
  const Medium& medium, const Illumination& illumination);
}
