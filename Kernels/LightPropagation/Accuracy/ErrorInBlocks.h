#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Light/KeptLight.h"
#include "LightPropagation/Accuracy/TargetError.h"

namespace tyndall
{
// SolveInBlocks (PropagationInBlocks.h) with error estimates that equal those of a serial solve: the coarse grid is
// that of the domain, decomposed anew. Collective. If the coarse solves use DSA and UncollidedDirections is left open,
// boundary light uses the directions of scattered light on the coarse grid. If it had finer directions on the grid
// itself, the estimate is then too large by the error of the coarser ones.

/// SolveWithErrorEstimate (ErrorEstimate.h) on a decomposed domain.
/// @param kept  light of the previous solve on the grid itself, as in SolveInBlocks
/// @throws as SolveInBlocks
LightField SolveInBlocksWithErrorEstimate(Device& device, const SceneInBlocks& scene,
  const PropagationSettings& settings, const Monitor& monitor = {}, KeptLight* kept = nullptr);

/// SolveToTargetError (TargetError.h) on a decomposed domain.
/// @param kept  light of the previous solve on the grid itself, as in SolveInBlocks
/// @throws as SolveInBlocks
TargetLight SolveInBlocksToTargetError(Device& device, const SceneInBlocks& scene, const PropagationSettings& settings,
  double target, const Monitor& monitor = {}, KeptLight* kept = nullptr);
}
