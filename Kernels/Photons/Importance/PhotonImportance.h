#pragma once

#include "Lights/Lights.h"
#include "Photons/Importance/ImportanceMap.h"
#include "Photons/Marching/PhotonMarcher.h"

#include <string>

namespace tyndall
{
struct ImportanceSettings
{
  /// Photons of each light; the largest square number that is not above it is made, its root is the map's size. At
  /// least 1. Some tenth of the photons to follow. Best a multiple of the cells along an axis, squared: else even light
  /// looks striped.
  std::size_t pilotCount = 1024;
  std::array<int, 3> cells = { 16, 16, 16 }; ///< of the coarse grid, each at least 1
  std::uint64_t seed = 0;

  /// Thresholds from the pilot photons' own statistics, in proportion to the light (numerics.md, Eq. (96)). Else the
  /// two below.
  bool automatic = true;
  double gradientThreshold = 0.0;  ///< W / length^2 from a cell to the next: cells at or above it are chosen
  double luminanceThreshold = 0.0; ///< W / length^2: lit cells at or below it are chosen
  double background = 0.3;         ///< part of the photons that are spread evenly, (0, 1]
};

struct Importance
{
  ImportanceMap map;           ///< mean 1 for each light
  PilotLight pilot;            ///< of all lights; origins are those of the first light that reaches the cell
  std::vector<float> gradient; ///< W / length^2 from a cell to the next, one per cell
  std::vector<float> chosen;   ///< 1 where a cell is to be sampled densely, else 0
  double gradientThreshold = 0.0, luminanceThreshold = 0.0; ///< as used
  /// Whether the light is so even that nothing is gained: the map is 1 everywhere, and photons are best spread evenly.
  bool even = false;
  std::vector<std::string> leftOut;
  double seconds = 0.0;
};

/// Where photons are needed (Pfeuti 2009, section 3.2.2; numerics.md, section 12.2): pilot photons on a jittered grid
/// are gathered in coarse cells; cells with a steep gradient of light, and dark ones, are chosen; each is drawn into
/// the map as a circle about the mean origin of its photons, as wide as they deviate from it; a 5x5 Gauss filter of
/// variance 2 smooths the map, and a background is added.
///
/// Collective. @param marcher  of the medium @param illumination, settings  the same on all ranks
/// @throws InvalidInput where a setting is out of its range; Aborted
Importance FindImportance(PhotonMarcher& marcher, const Grid& grid, const Illumination& illumination,
  const ImportanceSettings& settings = {}, const Monitor& monitor = {});
}
