#include "LightPropagation/Accuracy/ErrorInBlocks.h"

#include "LightPropagation/Distributed/PropagationInBlocks.h"

namespace tyndall
{
namespace
{
SolverInBlocks SolverOf(Device& device, const SceneInBlocks& given, KeptLight* kept)
{
  const Medium* const ofGrid = &given.medium; // not for coarser or refined grids
  return [=, &device](const SceneInBlocks& scene, const PropagationSettings& settings, const Monitor& monitor) {
    return SolveInBlocks(device, scene.others, scene.partition, scene.medium, scene.illumination, settings, monitor,
      &scene.medium == ofGrid ? kept : nullptr);
  };
}
}

LightField SolveInBlocksWithErrorEstimate(Device& device, const SceneInBlocks& scene,
  const PropagationSettings& settings, const Monitor& monitor, KeptLight* kept)
{
  return SolveWithErrorEstimate(scene, settings, monitor, SolverOf(device, scene, kept));
}

TargetLight SolveInBlocksToTargetError(Device& device, const SceneInBlocks& scene, const PropagationSettings& settings,
  double target, const Monitor& monitor, KeptLight* kept)
{
  Check(Domain(scene.others, scene.partition), scene.medium, scene.illumination,
    settings); // before coarse grids are solved
  return SolveToTargetError(scene, settings, target, monitor, SolverOf(device, scene, kept));
}
}
