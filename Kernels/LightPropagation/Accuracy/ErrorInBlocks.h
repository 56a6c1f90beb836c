#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Light/KeptLight.h"
#include "LightPropagation/Accuracy/TargetError.h"

namespace tyndall
{
// SolveInBlocks (PropagationInBlocks.h) with the error that its light has, as the whole has it: the coarse grid is that
// of the whole grid, in blocks of its own. All ranks call these together. Light from outside goes along the directions
// of scattered light where coarse voxels are balanced and UncollidedDirections was left open: the estimate is larger
// then, by what these leave, where those of the grid itself were finer.

/// SolveWithErrorEstimate (ErrorEstimate.h).
/// @param kept  as SolveInBlocks has it, of solves on the grid itself
/// @throws as SolveInBlocks
LightField SolveInBlocksWithErrorEstimate(Device& device, const SceneInBlocks& scene,
  const PropagationSettings& settings, const Monitor& monitor = {}, KeptLight* kept = nullptr);

/// SolveToTargetError (TargetError.h).
/// @param kept  as SolveInBlocks has it, of solves on the grid itself
/// @throws as SolveInBlocks
TargetLight SolveInBlocksToTargetError(Device& device, const SceneInBlocks& scene, const PropagationSettings& settings,
  double target, const Monitor& monitor = {}, KeptLight* kept = nullptr);
}
