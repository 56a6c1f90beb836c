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
    BalancesVoxels(device, Domain(scene.others, scene.partition), scene.medium, scene.illumination, alike);
  return balances ? alike : settings;
}

/// @param given, asked  scene and settings of the user
SolverInBlocks SolverOf(Device& device, const SceneInBlocks& given, const PropagationSettings& asked, KeptLight* kept)
{
  const bool open = asked.uncollidedDirections < 0;
  const Medium* const ofGrid = &given.medium; // not coarser, or divided
  return [=, &device](const SceneInBlocks& scene, const PropagationSettings& settings, const Monitor& monitor) {
    return SolveInBlocks(device, scene.others, scene.partition, scene.medium, scene.illumination,
      open ? AsBlocksCan(device, scene, settings) : settings, monitor, &scene.medium == ofGrid ? kept : nullptr);
  };
}
}

LightField SolveInBlocksWithErrorEstimate(Device& device, const SceneInBlocks& scene,
  const PropagationSettings& settings, const Monitor& monitor, KeptLight* kept)
{
  return SolveWithErrorEstimate(scene, settings, monitor, SolverOf(device, scene, settings, kept));
}

TargetLight SolveInBlocksToTargetError(Device& device, const SceneInBlocks& scene, const PropagationSettings& settings,
  double target, const Monitor& monitor, KeptLight* kept)
{
  Check(Domain(scene.others, scene.partition), scene.medium, scene.illumination, settings); // which goes to coarse ones
  return SolveToTargetError(scene, settings, target, monitor, SolverOf(device, scene, settings, kept));
}
}
