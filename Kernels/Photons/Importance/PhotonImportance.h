#pragma once

#include "Lights/Lights.h"
#include "Photons/Importance/ImportanceMap.h"
#include "Photons/Marching/PhotonMarcher.h"

#include <string>

namespace tyndall
{
struct ImportanceSettings
{
  /// Number of pilot photons per light, at least 1; about a tenth of the photons that will be marched. It is rounded
  /// down to a square number, whose root is the map's size. This root should be a multiple of the number of coarse
  /// cells along an axis: otherwise even uniform light looks striped.
  std::size_t pilotCount = 1024;
  std::array<int, 3> cells = { 16, 16, 16 }; ///< number of coarse cells along each axis, each at least 1
  std::uint64_t seed = 0;

  /// Whether both thresholds are computed from the statistics of the pilot photons' light, in proportion to it
  /// (numerics.md, Eq. (96)). If false, gradientThreshold and luminanceThreshold are used.
  bool automatic = true;
  /// W / length^2: cells are chosen if their fluence differs from that of their neighbours by this value or more.
  double gradientThreshold = 0.0;
  double luminanceThreshold = 0.0; ///< W / length^2: lit cells are chosen if their luminance is at most this value
  double background = 0.3;         ///< fraction of the photons that are distributed uniformly, (0, 1]
};

struct Importance
{
  ImportanceMap map; ///< relative density of photon origins on each light's photon plane, mean 1 for each light
  /// Light of the pilot photons of all lamps, in coarse cells. A cell stores the origins of photons of one lamp, the
  /// first in the list whose photons reach the cell. An origin is a position on the photon plane.
  PilotLight pilot;
  std::vector<float> gradient; ///< W / length^2, difference of fluence between neighbouring cells, one value per cell
  std::vector<float> chosen;   ///< by cell: 1 if it is to be sampled densely, else 0
  double gradientThreshold = 0.0, luminanceThreshold = 0.0; ///< W / length^2, the thresholds that were used
  /// True if the light is too even for importance sampling to help. The map is then 1 everywhere, and photons should be
  /// distributed uniformly.
  bool even = false;
  std::vector<std::string> leftOut;
};

/// Computes the importance map of photon origins (Pfeuti 2009, section 3.2.2; numerics.md, section 12.2). Pilot photons
/// start on a jittered grid, and their light is summed in coarse cells. Cells with a steep gradient of light, and dark
/// cells, are chosen. Each chosen cell is drawn into the map as a circle around the mean origin of its photons, with a
/// diameter from the standard deviations of the origins. A 5x5 Gaussian filter of variance 2 smooths the map, and a
/// uniform background is added.
///
/// Collective.
/// @param marcher  marcher of the pilot photons, with the medium in which they are marched
/// @param illumination, settings  the same on all ranks
/// @throws InvalidInput if a setting is out of range; Aborted
Importance FindImportance(PhotonMarcher& marcher, const Grid& grid, const Illumination& illumination,
  const ImportanceSettings& settings = {}, const Monitor& monitor = {});
}
