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
/// Collective: all ranks take the same decisions, on coarse and refined blocks of their own.
/// @param scene  with the same kinds of fields on all ranks
/// @param target  relative error, in (0, 1)
/// @throws InvalidInput  if the target or the scene is invalid (SceneChecks.h)
TargetLight SolveToTargetError(const SceneBlock& scene, const PropagationSettings& settings, double target,
  const Monitor& monitor, const PropagationSolver& solve);
}
