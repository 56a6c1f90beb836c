#pragma once

#include "Device/Monitor.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Photons/Emission/SampleSequence.h"
#include "Photons/Importance/ImportanceMap.h"
#include "Photons/Photons.h"

namespace tyndall
{
/// Maximum number of batches that the conservative reconstruction compares.
constexpr int EmittedBatchesAtMost = 16;

struct EmissionSettings
{
  /// Number of photons that reach the volume, of all lights together. Each light has a share in proportion to the power
  /// that it sends into the volume, at least one photon. For spots and rectangles that partly miss the volume, the
  /// number is met within a percent.
  std::size_t photonCount = 100000;
  Sampler sampler = Sampler::Hammersley;
  std::uint64_t seed = 0;
  /// Number of independent batches, 1 to 16. Each batch shifts the sample sequence differently; every second one also
  /// exchanges the first two coordinates, and Hammersley's bases 2 and 3, so that the patterns of two batches are
  /// unrelated.
  int batches = 1;
  /// Relative density of photon origins; null or empty: uniform. Lights without a square in the map are sampled
  /// uniformly.
  const ImportanceMap* map = nullptr;
  /// Upper limit of the density that the map may ask for, relative to uniform sampling; at least 1.
  double densestAtMost = 8.0;
  /// Emit only part `part` of `parts`: all parts, one after the other, are all photons in their order.
  int part = 0, parts = 1;
};

/// Emitted photons where they enter the volume (those of a lamp in the volume: at the lamp), and for each the number of
/// its light: its index in `illumination.lights`, EnvironmentLight for the environment and the sky, -2 for the faces.
struct EmittedPhotons
{
  std::vector<Photon> photons;
  std::vector<int> lights;
  Rgb power = {};       ///< W, total power of these photons
  double seconds = 0.0; ///< duration of the emission
};

/// Samples the photons emitted by all lights (Pfeuti 2009, section 3.1.4; numerics.md, Eq. (94)), in double precision
/// on the host. Photons that would miss the volume are not made, and the power of the emitted ones is the power that
/// really reaches the volume:
///
///  - directional: uniform over the outline of the volume on the photon plane perpendicular to the direction
///  - point: uniform in the solid angle of the faces that the lamp sees, or isotropic for a lamp in the volume; a lamp
///    on a face, an edge or a corner emits only into the volume (LampView)
///  - spot: over its cone or the solid angle of the volume, whichever is smaller; samples outside the other one are
///    rejected
///  - rectangle: from points on it to the faces that each point sees, power weighted by the cosine; in the volume,
///    into a half-space; a rectangle that looks large from the volume: from points on the faces, over the rectangle's
///    solid angle as seen from each
///  - environment and sky: direction by radiance, solid angle and projected area of the volume, then position over
///    that outline
///  - faces: uniform over each face, directions cosine-weighted
///
/// The index outside is assumed constant.
///
/// @throws InvalidInput if the illumination is not valid or photonCount is 0; DeviceError if the machine's memory does
///   not suffice for the photons (60 bytes each); Aborted
EmittedPhotons EmitPhotons(
  const Grid& grid, const Illumination& illumination, const EmissionSettings& settings, const Monitor& monitor = {});

/// Pilot photons of one light.
struct PilotPhotons
{
  int light = 0;               ///< number of the light
  std::vector<Photon> photons; ///< photons of the edge * edge samples that reach the volume
  /// Column and row of the photon-plane cell that each photon was sampled in.
  std::vector<std::array<int, 2>> origins;
};

/// Pilot photons of every light, the environment and the sky, but not of the faces: one at a random place in each cell
/// of a square grid on the photon plane (Pfeuti 2009, section 3.2.2).
/// @param edge  cells along an edge of the grid, at least 1
/// @throws InvalidInput if the illumination is not valid
std::vector<PilotPhotons> EmitPilots(
  const Grid& grid, const Illumination& illumination, int edge, std::uint64_t seed = 0);
}
