#pragma once

#include "Medium/Medium.h"

#include <array>
#include <string>
#include <vector>

namespace bench
{
/// An absorber in which a box of voxels shines; it owns its arrays. Moves, does not copy.
struct EmissionScene
{
  EmissionScene(const std::string& name, std::array<int, 3> size, std::array<double, 3> spacing, int channels);
  EmissionScene(EmissionScene&&) = default;
  EmissionScene(const EmissionScene&) = delete;
  EmissionScene& operator=(const EmissionScene&) = delete;

  std::string name;
  tyndall::Medium medium;
  std::array<int, 3> sourceFirst = { 0, 0, 0 }, sourceSize = { 1, 1, 1 }; ///< the box of what shines
  std::vector<float> sigma_a;                                             ///< [voxel], of all channels
  std::vector<float> emission;                                            ///< [voxel][channel]
  std::vector<float> sigma_s;                                             ///< 0
  double error = 0.02;                                                    ///< EmissionError asked for
};

/// Cubes of `edge` voxels around one peak, or with one in a corner; thin, thick, by chance; in colours. Kobayashi's
/// problems 2 and 3 (a duct, straight and with corners, in a shield) without scattering, 60 x 100 x 60 voxels.
std::vector<EmissionScene> EmissionScenes(int edge);
}
