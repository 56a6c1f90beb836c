#include "LightPropagation/Accuracy/ErrorInBlocks.h"

#include "LightPropagation/Distributed/PropagationInBlocks.h"

namespace tyndall
{
namespace
{
/// Balanced voxels have no finer directions of unscattered light: with those they would be swept order by order.
PropagationSettings AsBlocksCan(Device& device, const SceneInBlocks& scene, const PropagationSettings& settings)
{
  PropagationSettings alike = settings;
  alike.uncollidedDirections = 0;
  const bool balances = settings.uncollidedDirections > 0 &&
    BalancesVoxels(device, scene.others, scene.partition, scene.medium, scene.illumination, alike);
  return balances ? alike : settings;
}

/// @param asked  settings of the user
SolverInBlocks SolverOf(Device& device, const PropagationSettings& asked)
{
  const bool open = asked.uncollidedDirections < 0;
  return [&device, open](const SceneInBlocks& scene, const PropagationSettings& settings, const Monitor& monitor) {
    return SolveInBlocks(device, scene.others, scene.partition, scene.medium, scene.illumination,
      open ? AsBlocksCan(device, scene, settings) : settings, monitor);
  };
}
}

LightField SolveInBlocksWithErrorEstimate(
  Device& device, const SceneInBlocks& scene, const PropagationSettings& settings, const Monitor& monitor)
{
  return SolveWithErrorEstimate(scene, settings, monitor, SolverOf(device, settings));
}

TargetLight SolveInBlocksToTargetError(Device& device, const SceneInBlocks& scene, const PropagationSettings& settings,
  double target, const Monitor& monitor)
{
  CheckBlocks(scene.others, scene.partition, scene.medium, scene.illumination, settings); // which goes to coarse ones
  return SolveToTargetError(scene, settings, target, monitor, SolverOf(device, settings));
}
}
