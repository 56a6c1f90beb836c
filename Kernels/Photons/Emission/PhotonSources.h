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
/// Four coordinates in [0, 1) from which one photon is computed.
using PhotonSample = std::array<double, 4>;

/// A photon as its light emits it.
struct Shot
{
  glm::dvec3 from, direction;
  Rgb power; ///< W, as if it were the only photon of its light
};

/// Maps sample points to photons of one light; rejects samples where the light emits nothing.
struct PhotonSource
{
  int light = 0; ///< number of the light, see EmittedPhotons
  std::function<std::optional<Shot>(const PhotonSample&)> shoot;
  bool alike = false; ///< all of its photons reach the volume, with equal power
};

/// Sources for all lights of the illumination, sampled as documented at EmitPhotons. Boundary sources (faces) come
/// last.
std::vector<PhotonSource> PhotonSourcesOf(const Grid& grid, const Illumination& illumination);

/// Moves a photon to where it enters the volume; empty if it misses.
std::optional<Photon> Land(const Grid& grid, const Shot& shot);
}
