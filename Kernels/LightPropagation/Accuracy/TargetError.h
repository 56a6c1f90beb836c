#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Result of SolveToTargetError(): the light, its settings, and the cost.
struct TargetLight
{
  /// The light with its estimated relativeError; `doubts` has a warning if the target was missed.
  LightField light;
  PropagationSettings settings; ///< settings of the final solve
  bool met = false;             ///< whether the estimated error is at most the target
  bool divided = false;         ///< whether the light was solved with voxels of half the edge length
  int solves = 0;               ///< number of solves, including those on coarse grids
  double seconds = 0.0;         ///< total time of all solves, s
};

/// Solves a scene to a target error, each colour on its own if the medium is coloured: every colour then meets the
/// target, with the directions that it needs and with the same light as a scene of this colour alone. Collective.
/// @param solve  solves a scene to the target; returns the light with `solves` and `settingsUsed`
LightField SolveColours(const SceneBlock& scene, const Monitor& monitor,
  const std::function<LightField(const SceneBlock&, const Monitor&)>& solve);

/// Solves a scene of three channels, each channel as a scene of its own. Collective.
/// @param solve  as for SolveColours()
LightField SolveEachColour(const SceneBlock& scene, const Monitor& monitor,
  const std::function<LightField(const SceneBlock&, const Monitor&)>& solve);

/// The light of a search for a target error, with its members `solves` and `settingsUsed` set.
/// @param settings  settings of the final solve, as texts "Name = value"; VoxelsDividedBy is appended
LightField LightOf(TargetLight&& found, std::vector<std::string> settings);

/// Solves a scene such that the estimated relative error of fluence (root mean square relative to that of fluence) is
/// below a target, with the least predicted work:
///  1. solve with few and with more directions on the grid of half the voxels per axis, to estimate the angular error
///     (DirectionForecast.h);
///  2. solve on the scene's grid with the cheapest sufficient numbers of directions for scattered and for uncollided
///     light, and the tolerance that the target allows;
///  3. solve with the same settings on the coarse grid, to estimate the error in voxel size and correct the prediction;
///     repeat with more directions if there were too few;
///  4. if voxels are too coarse, and voxels of half the edge length are predicted to suffice, solve with those (eight
///     times the work and memory) and average the result.
/// Settings that differ from their default values are not changed. Because the estimate itself has an error, the search
/// aims at an estimate of 0.95 times the target, of which 0.9 is allowed for the angular error. `met` refers to the
/// estimate. Collective: all ranks take the same decisions, with coarse and refined subdomains of their own.
/// @param scene  scene with values in the same fields on all ranks
/// @param target  relative error, in (0, 1)
/// @throws InvalidInput  if the target or the scene is invalid (SceneChecks.h)
TargetLight SolveToTargetError(const SceneBlock& scene, const PropagationSettings& settings, double target,
  const Monitor& monitor, const PropagationSolver& solve, const ErrorOrders& orders = {});
}
