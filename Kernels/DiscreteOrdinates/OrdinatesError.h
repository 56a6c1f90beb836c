#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "LightPropagation/Accuracy/ResampledScene.h"

namespace tyndall
{
/// Solves a scene by discrete ordinates and estimates the error of its fluence, as SolveWithErrorEstimate
/// (ErrorEstimate.h). The estimate needs two more solves, on a grid of half the voxels per axis. The second of these
/// has fewer directions and, in the same proportion, fewer terms of the phase function. The error of replacing a mean
/// cosine that varies by voxel by its mean is not included. Collective.
/// @throws InvalidInput  for the published scheme, which has no estimate
/// @throws the exceptions of SolveDiscreteOrdinates
LightField EstimateOrdinates(
  Device& device, const SceneBlock& scene, const OrdinatesSettings& settings, const Monitor& monitor = {});

/// Solves a scene by discrete ordinates to a target error, as SolveToTargetError (TargetError.h), each colour of a
/// coloured medium on its own (SolveColours). It chooses directions per cube face, terms of the phase function (in
/// proportion to the directions), tolerance, and whether to halve the voxels; settings other than the default values
/// are not changed. The radiance along all directions takes at most half of the device's memory on the scene's grid.
/// Collective.
/// @param target  relative error, in (0, 1)
/// @return the light, with settingsUsed and solves; `doubts` has a warning if the target was missed
/// @throws InvalidInput  for the published scheme, for directions on a spiral, and if the target is out of range
/// @throws the exceptions of SolveDiscreteOrdinates
LightField SolveOrdinatesToTarget(Device& device, const SceneBlock& scene, const OrdinatesSettings& settings,
  double target, const Monitor& monitor = {});
}
