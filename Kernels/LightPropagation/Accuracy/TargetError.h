#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"

namespace tyndall
{
/// Light that was solved to a target, and at what cost.
struct TargetLight
{
  LightField light;             ///< its relativeError is the estimate; doubts say so where the target is missed
  PropagationSettings settings; ///< that it was solved with
  bool met = false;             ///< the estimate shows it
  bool divided = false;         ///< in voxels of half the edge
  int solves = 0;               ///< all together, those of the coarse grid as well
  double seconds = 0.0;         ///< of all of them
};

/// Solve such that the relative error of fluence (root mean square over that of fluence) is below a target, by the
/// solver's own estimate, as cheaply as a forecast has it:
///  1. along few and along more directions on the grid of half the voxels an axis, which tells the error that
///     directions leave (DirectionForecast.h);
///  2. along the cheapest directions that do, of scattered and of unscattered light each, on the grid itself, with the
///     tolerance that the target allows;
///  3. the same on the coarse grid, which tells the error in voxel size and corrects the forecast; once more along
///     more directions where these were too few;
///  4. in voxels of half the edge (eight times the work, and memory) where voxels are what is too coarse and these
///     promise to do, averaged back.
/// Settings that do not have their default value stay as they are. Directions are chosen such that the estimate is a
/// quarter below the target, for it has an error of its own; met is what the estimate shows.
/// @param target  relative, above 0
TargetLight SolveToTargetError(const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, double target, const Monitor& monitor, const PropagationSolver& solve);

/// The same of a scene that is spread over ranks, by coarse and divided blocks (ErrorEstimate.h). All ranks call it
/// together, with a scene that is alike on all in what it has, and come to the same.
TargetLight SolveToTargetError(const SceneInBlocks& scene, const PropagationSettings& settings, double target,
  const Monitor& monitor, const SolverInBlocks& solve);
}
