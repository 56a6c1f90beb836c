#pragma once

#include "Device/Monitor.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Photons/Emission/SampleSequence.h"
#include "Photons/Importance/ImportanceMap.h"
#include "Photons/Photons.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Maximum number of photon batches that the conservative reconstruction can compare.
constexpr int EmittedBatchesAtMost = 16;

struct EmissionSettings
{
  /// Number of photons that reach the volume, of all lights together. Each light emits a share in proportion to the
  /// power that it sends into the volume, at least one photon. If spots or rectangles partly miss the volume, the
  /// number is met within a percent.
  std::size_t photonCount = 100000;
  Sampler sampler = Sampler::Hammersley;
  std::uint64_t seed = 0;
  /// Number of independent batches, 1 to 16. Each batch shifts the sample sequence by a different vector. Every second
  /// batch also exchanges the first two coordinates, and Hammersley's bases 2 and 3, so that the errors of consecutive
  /// batches are not correlated.
  int batches = 1;
  /// Relative density of photon origins (the points of a light's photon plane where its photons start); null or empty:
  /// uniform. Photons of lights for which the map has no density are sampled uniformly.
  const ImportanceMap* map = nullptr;
  /// Upper limit of the photon density that the map may request, relative to uniform sampling; at least 1.
  double densestAtMost = 8.0;
  /// Emission may be computed in several parts. `part` is the number, from 0, of the part to compute, and `parts` the
  /// number of parts. The photons of all parts, one part after another, are those of an undivided emission, in the same
  /// order.
  int part = 0, parts = 1;
};

/// Emitted photons at the points where they enter the volume (photons of a lamp inside the volume: at the lamp).
struct EmittedPhotons
{
  std::vector<Photon> photons;
  /// The light of each photon: its index in `illumination.lights`, EnvironmentLight for the environment and the sky, -2
  /// for light that enters through the faces.
  std::vector<int> lights;
  Rgb power = {};                   ///< W, total power of the emitted photons
  std::vector<std::string> leftOut; ///< texts of left_out, of the photons of all parts
};

/// Samples the photons emitted by all lights (Pfeuti 2009, section 3.1.4; numerics.md, Eq. (94)), in double precision
/// on the host. Photons that would miss the volume are not emitted, and the power of the emitted photons is the power
/// that reaches the volume:
///
///  - directional: uniform over the outline of the volume on the photon plane perpendicular to the direction
///  - point: uniform in the solid angle of the faces that the lamp sees, or isotropic for a lamp in the volume; a lamp
///    on a face, an edge or a corner emits only into the volume (LampView)
///  - spot: over the smaller of its cone and the solid angle of the volume; samples outside the larger one are
///    rejected
///  - rectangle: from points on the rectangle to the faces of the volume that each point sees, power weighted by the
///    cosine; for points inside the volume, into a half-space. A rectangle that is large as seen from the volume: from
///    points on the faces, over the solid angle of the rectangle as seen from each point
///  - environment and sky: direction by radiance, solid angle and projected area of the volume, then position over
///    the outline of the volume in that direction
///  - faces: uniform over each face of the volume, directions cosine-weighted
///
/// The refractive index outside the volume is assumed constant.
///
/// @throws InvalidInput if the illumination is not valid or photonCount is 0; DeviceError if the machine's memory does
///   not suffice for the photons (60 bytes each); Aborted
EmittedPhotons EmitPhotons(
  const Grid& grid, const Illumination& illumination, const EmissionSettings& settings, const Monitor& monitor = {});

/// Pilot photons of one light: a few photons that are traced before the others, to compute the light's importance map.
struct PilotPhotons
{
  int light = 0; ///< index of the light in `illumination.lights`, or EnvironmentLight for environment and sky
  std::vector<Photon> photons; ///< photons of those samples that reach the volume, out of edge * edge samples
  /// Column and row of the photon-plane cell from which each photon was sampled.
  std::vector<std::array<int, 2>> origins;
};

/// Emits the pilot photons of every light, the environment and the sky, but not of the faces. One photon starts at a
/// random position in each cell of a square grid on the photon plane (Pfeuti 2009, section 3.2.2).
/// @param edge  number of cells along an edge of the grid, at least 1
/// @throws InvalidInput if the illumination is not valid
std::vector<PilotPhotons> EmitPilots(
  const Grid& grid, const Illumination& illumination, int edge, std::uint64_t seed = 0);
}
