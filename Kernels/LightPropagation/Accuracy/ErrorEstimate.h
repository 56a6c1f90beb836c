#pragma once

#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"

#include "Device/Monitor.h"
#include "Medium/Coarsening.h"
#include "Medium/Medium.h"

#include <functional>
#include <vector>

namespace tyndall
{
/// Solves a medium of the same box, with the same light on its grid, with settings.
using PropagationSolver =
  std::function<LightField(const Medium&, const Illumination&, const PropagationSettings&, const Monitor&)>;

/// Errors of light by the two parts of Eq. (84) that are looked at apart, each a root mean square over that of fluence.
struct ErrorParts
{
  double inSpace = 0.0, inDirections = 0.0, residual = 0.0;
};

/// Fills in fluenceError and relativeError of light (Eqs. (82) to (84)).
/// @param coarsening  of the light's grid
/// @param same, other  fluence on the coarse grid, along the same directions and along others
/// @param partOfDifference  error of the light's directions over its difference to that of the others
/// @param orderInSpace  that the error falls with in voxel size
ErrorParts WriteErrorEstimate(LightField& light, const Coarsening& coarsening, const std::vector<float>& same,
  const std::vector<float>& other, double partOfDifference, double orderInSpace);

/// Solve, and estimate the error of fluence without a reference, from two more solves on a grid of half the voxels an
/// axis (numerics.md, section 9.2):
///  - in voxel size, of order 2 (Richardson), Eq. (82);
///  - in directions, by 0.6 times as many along a face's edge, Eq. (83);
///  - of scattering orders that were not computed: the residual.
/// fluenceError is a standard error, Eq. (84); relativeError that of all voxels. Too large where the medium has edges
/// as sharp as a voxel (coarsening blurs them), and next to a lamp too large or too small by up to a factor of two.
/// What was measured: measurements.md.
///
/// Not known of a solve that was stopped after its first order while light was left: one order does not tell how fast
/// orders shrink. relativeError is NaN then, and fluenceError empty.
///
/// Takes 1 / 8 + 1 / 20 of the sweeps' time, more where the grid is small. An axis of a single voxel is not coarsened,
/// and its error in voxel size not seen.
LightField SolveWithErrorEstimate(const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor, const PropagationSolver& solve);
}
