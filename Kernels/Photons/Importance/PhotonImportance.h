#pragma once

#include "Lights/Lights.h"
#include "Photons/Importance/ImportanceMap.h"
#include "Photons/Marching/PhotonMarcher.h"

#include <string>

namespace tyndall
{
struct ImportanceSettings
{
  /// Pilot photons per light, at least 1; about a tenth of the photons that will be marched. Rounded down to a square
  /// number, whose root is the map's size. Preferably the square of a multiple of the cells along an axis: otherwise
  /// even uniform light looks striped.
  std::size_t pilotCount = 1024;
  std::array<int, 3> cells = { 16, 16, 16 }; ///< of the coarse grid, each at least 1
  std::uint64_t seed = 0;

  /// Whether both thresholds are computed from the pilot photons' own statistics, in proportion to the light
  /// (numerics.md, Eq. (96)). Otherwise the two values below are used.
  bool automatic = true;
  /// W / length^2, difference between neighbouring cells: cells at or above it are chosen.
  double gradientThreshold = 0.0;
  double luminanceThreshold = 0.0; ///< W / length^2: lit cells at or below it are chosen
  double background = 0.3;         ///< fraction of the photons that are spread evenly, (0, 1]
};

struct Importance
{
  ImportanceMap map;           ///< mean 1 for each light
  PilotLight pilot;            ///< light of all lights; origins are those of the first light that reaches the cell
  std::vector<float> gradient; ///< W / length^2, difference between neighbouring cells, one per cell
  std::vector<float> chosen;   ///< 1 for cells to sample densely, else 0
  double gradientThreshold = 0.0, luminanceThreshold = 0.0; ///< the thresholds used
  /// Whether the light is too even for importance sampling to help: the map is 1 everywhere; spread photons evenly.
  bool even = false;
  std::vector<std::string> leftOut;
  double seconds = 0.0;
};

/// Finds where photons are needed (Pfeuti 2009, section 3.2.2; numerics.md, section 12.2). Pilot photons on a jittered
/// grid are gathered in coarse cells; cells with a steep gradient of light, and dark cells, are chosen. Each chosen
/// cell is drawn into the map as a circle around the mean origin of its photons, with a diameter from their standard
/// deviations; a 5x5 Gaussian filter of variance 2 smooths the map, and a uniform background is added.
///
/// Collective. @param marcher  its medium is sampled @param illumination, settings  the same on all ranks
/// @throws InvalidInput if a setting is out of range; Aborted
Importance FindImportance(PhotonMarcher& marcher, const Grid& grid, const Illumination& illumination,
  const ImportanceSettings& settings = {}, const Monitor& monitor = {});
}
