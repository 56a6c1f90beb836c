#pragma once

#include "Device/Device.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Medium/Traits.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace bench
{
/// A cloud in which nothing can be left out: coloured, it scatters, absorbs and shines, under a coloured sky; the
/// memory of its arrays. Traits are given to it one by one. Moves, does not copy.
struct TraitScene
{
  explicit TraitScene(std::array<int, 3> size);
  TraitScene(TraitScene&&) = default;

  void BeGrey();          ///< medium and light
  void ShareExtinction(); ///< only the albedo is coloured
  void LightInOneColour();
  /// The medium is within this part of the box along each axis, in its middle; else vacuum.
  void LeaveEmpty(double filled);

  std::string GridName() const;

  tyndall::Medium medium;
  tyndall::Illumination light;
  tyndall::PropagationSettings settings;
  std::vector<float> sigma_a, sigma_s, emission; ///< three components
};

/// A scene with one trait and a solver.
struct TraitCase
{
  std::string name, solver, grid;
  std::string against; ///< what all that is computed is called
  std::function<std::vector<float>(bool leaveOut)> solve;
};

/// @param edge  of most grids, voxels
std::vector<TraitCase> TraitCases(tyndall::Device& device, int edge);
}
