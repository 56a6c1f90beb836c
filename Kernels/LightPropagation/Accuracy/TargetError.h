#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"

namespace tyndall
{
/// Light solved to a target error, and the cost.
struct TargetLight
{
  LightField light;             ///< relativeError is the estimate; `doubts` tells if the target was missed
  PropagationSettings settings; ///< settings of the final solve
  bool met = false;             ///< the estimate is below the target
  bool divided = false;         ///< solved with voxels of half the edge length
  int solves = 0;               ///< number of solves, including those on coarse grids
  double seconds = 0.0;         ///< total time of these
};

/// Solves to a relative error of fluence (root mean square relative to that of fluence) below a target, by the solver's
/// own estimate, as cheaply as predicted:
///  1. solve with few and with more directions on the grid of half the voxels per axis, to estimate the angular error
///     (DirectionForecast.h);
///  2. solve on the grid itself with the cheapest sufficient numbers of directions for scattered and for uncollided
///     light, and the tolerance that the target allows;
///  3. solve the same on the coarse grid, to estimate the error in voxel size and correct the prediction; repeat with
///     more directions if there were too few;
///  4. if voxels are too coarse, and voxels of half the edge length promise to suffice, solve with those (eight times
///     the work and memory) and average the result.
/// Settings that differ from their default values are not changed. Directions are chosen for an estimate a quarter
/// below the target, because the estimate itself has an error; `met` refers to the estimate.
/// @param target  relative error, > 0
TargetLight SolveToTargetError(const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, double target, const Monitor& monitor, const PropagationSolver& solve);

/// The same for a decomposed scene, with coarse and refined blocks (ErrorEstimate.h). Collective; all ranks must have
/// the same kinds of fields, and get the same decisions.
TargetLight SolveToTargetError(const SceneInBlocks& scene, const PropagationSettings& settings, double target,
  const Monitor& monitor, const SolverInBlocks& solve);
}
