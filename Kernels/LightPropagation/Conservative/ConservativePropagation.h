#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <functional>
#include <string>

namespace tyndall
{
class PropagationProblem;
class TransportParts;
enum class IterationScheme;

/// Light propagation maps with energy conservation: the method of Fattal (2009) and Gruson et al. (2012), with
///  - conservative deposit: each voxel gains the power that a ray loses in it (numerics.md, Eqs. (23) to (27)), without
///    division by sigma_t;
///  - fitted angular quadratures (FittedDirections);
///  - lamps, peaks of the environment and localised emission as first-collision sources along exact rays;
///  - boundary light along a finer quadrature until its first collision, depending on settings.uncollidedDirections;
///  - source iteration, or diffusion synthetic acceleration where light scatters many times (numerics.md, sections 6,
///    7);
///  - propagation and collection in one pass over the grid. Memory: about five arrays over voxels (sigma_t, sigma_s,
///    source, path integral, fluence) and the ray state of the sweep.
///
/// A medium with g other than 0 is solved in angular moments up to a degree, settings.angularDegree. Scattering beyond
/// that degree is treated as unscattered forward light (delta-M, numerics.md, section 2.2), and leftOut says so.
///
/// With several ranks each rank solves its subdomain (numerics.md, section 4.9). Sweeps are pipelined from rank to rank
/// (SweepInBlocks.h), and all decisions and sums are global. The fluence therefore equals that of a serial solve: to
/// rounding with source iteration, to the tolerance with acceleration. A rank holds its block, a halo of one voxel if
/// the source is linear, and values by cell of the box faces if these reflect or face power is requested. Serial only:
/// the plane-parallel solver, and exact rays for localised emission in more than 2^24 voxels (ReasonNotToDecompose).
///
/// Collective.
/// @param domain  the decomposed grid
/// @param medium  of this rank's block; for a block without voxels only the grid is read
/// @param illumination, settings  equal on all ranks, except for settings.memoryBudget
/// @param kept  light of the previous solve, used as first guess and replaced by the light of this solve (KeptLight.h);
///   null: no first guess, and no light is kept. Null on all ranks or on none
/// @return the light of this rank's block; balance, face powers and convergence are of the whole domain
/// @throws InvalidInput  from Check(domain, ...) (SceneChecks.h)
/// @throws DeviceError  if the buffers do not fit
/// @throws Aborted  if the monitor aborts the solve
LightField SolveConservative(Device& device, const Domain& domain, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor = {},
  KeptLight* kept = nullptr);
/// Solves a problem by sweeps with the given iteration scheme; the last steps of SolveConservative(). Collective.
/// @param illumination  the user's, from which `problem` was made
/// @param replace  called with the parts of the solve before the iteration begins, to set another transport of
///   scattered light (TransportParts::Scattered); empty: none
LightField SolveBySweeps(Device& device, const PropagationProblem& problem, const Illumination& illumination,
  IterationScheme how, const Monitor& monitor, KeptLight* kept,
  const std::function<void(TransportParts& parts)>& replace = {});
/// SolveConservative() on a serial domain, the grid of the medium.
inline LightField SolveConservative(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor = {}, KeptLight* kept = nullptr)
{
  return SolveConservative(device, Domain(medium.grid), medium, illumination, settings, monitor, kept);
}

/// Why the serial solver would be more accurate or much faster for this scene, as text that completes the sentence "the
/// whole is better for ..."; empty if it would not. Collective. @throws as SolveConservative
std::string ReasonNotToDecompose(Device& device, const Domain& domain, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings);
}
