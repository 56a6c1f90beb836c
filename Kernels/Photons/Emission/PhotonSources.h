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
/// Four sample coordinates in [0, 1) from which one photon is computed.
using PhotonSample = std::array<double, 4>;

/// A photon as its light emits it, before it is moved to the volume.
struct Shot
{
  glm::dvec3 from, direction;
  Rgb power; ///< W, power of the photon if it were the only photon of its light
};

/// Sampler of the photons of one light: maps sample points to photons, and rejects samples for which the light emits
/// nothing.
struct PhotonSource
{
  int light = 0; ///< index of the light in the illumination; EnvironmentLight: environment and sky; -2: the faces
  std::function<std::optional<Shot>(const PhotonSample&)> shoot;
  bool alike = false; ///< whether all photons of this light reach the volume with equal power
};

/// Returns the sources of all lights of the illumination, sampled as documented at EmitPhotons. Light that enters
/// through the faces comes last.
std::vector<PhotonSource> PhotonSourcesOf(const Grid& grid, const Illumination& illumination);

/// Moves a photon along its direction to the point where it enters the volume; empty if it misses the volume.
std::optional<Photon> Land(const Grid& grid, const Shot& shot);
}
