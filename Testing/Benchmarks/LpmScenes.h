#pragma once

#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <string>
#include <vector>

namespace bench
{
/// A medium under a sky, its longest edge 1, and the memory of its arrays. Moves, does not copy.
struct Scene
{
  std::string name;
  int channels = 1;
  tyndall::Medium medium;
  tyndall::Illumination light;
  std::vector<float> sigma_a, sigma_s;

  Scene() = default;
  Scene(Scene&&) = default;

  std::string GridName() const; ///< "64x64x64"
};

/// Voxels that have nothing to do with each other, a tenth of them empty; a box 8 mean free paths thick whatever its
/// voxels.
/// @param channels  1: albedo 0.9, white sky; 3: albedo 0.95, 0.9, 0.8, bluish sky, one sigma_t
Scene RandomScene(int edge, int channels);

/// The CT scan: sigma_t in proportion to what the scanner saw, 100 mean free paths an edge where that is densest.
/// @param file  skull_2.9.inr: a header of 256 characters (INRIMAGE-4), then the voxels
/// @throws std::runtime_error if it is not such a file
Scene ScanScene(const std::string& file, int channels);
}
