#pragma once

#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Photons/Photons.h"

#include <array>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace tyndall
{
/// Four coordinates in [0, 1) that a photon is made of.
using PhotonSample = std::array<double, 4>;

/// A photon as it leaves its light.
struct Shot
{
  glm::dvec3 from, direction;
  Rgb power; ///< W, if it was the only one of its light
};

/// What makes the photons of a light out of samples; of some samples none, where it gives nothing.
struct PhotonSource
{
  int light = 0; ///< number, as EmittedPhotons has it
  std::function<std::optional<Shot>(const PhotonSample&)> shoot;
  bool alike = false; ///< all of its photons reach the volume, with the same power
};

/// Sources of all that shines, as EmitPhotons says. Faces come last.
std::vector<PhotonSource> PhotonSourcesOf(const Grid& grid, const Illumination& illumination);

/// The photon where the shot enters the volume; nothing where it misses.
std::optional<Photon> Land(const Grid& grid, const Shot& shot);
}
