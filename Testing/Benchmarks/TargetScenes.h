#pragma once

#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <string>
#include <vector>

namespace bench
{
/// A scene for the target error. Moves, does not copy.
struct TargetScene
{
  std::string name;
  tyndall::Medium medium;
  tyndall::Illumination light;
  std::vector<float> sigma_a, sigma_s, emission;

  TargetScene() = default;
  TargetScene(TargetScene&&) = default;
  TargetScene& operator=(TargetScene&&) = default;
};

/// Scenes that the forecasts and their constants were chosen on (DirectionForecast.cxx, TargetError.cxx).
std::vector<TargetScene> TuningScenes(double size);

/// Six scenes, written down beforehand, that nothing was chosen on: two faces on a flat box, blocks of contrast 100, a
/// thick cloud under sun and sky, a plume that shines, two lamps in smoke, a cloud that scatters forwards.
/// @param size  1: grids of 40 to 48 voxels along the longest edge
std::vector<TargetScene> HeldOutScenes(double size);

/// 24 scenes of 12 to 24 voxels an axis, even numbers, that no constant of an error estimate was chosen on: thin to
/// thick, mean cosines from 0 to 0.9, empty parts, lamps inside, emission, three colours, stretched voxels.
/// @param cubes  whether stretched voxels are made cubes, as the lattice needs them
std::vector<TargetScene> CoverageScenes(bool cubes);
}
