#pragma once

#include "Device/Monitor.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Photons/Emission/SampleSequence.h"
#include "Photons/Importance/ImportanceMap.h"
#include "Photons/Photons.h"

namespace tyndall
{
constexpr int EmittedBatchesAtMost = 16; ///< as many as the conservative reconstruction compares

struct EmissionSettings
{
  /// Photons that reach the volume, of all lights together; each light has a share in proportion to the power with
  /// which it reaches the volume, at least one. Spots and rectangles of which a part misses the volume meet it within a
  /// percent.
  std::size_t photonCount = 100000;
  Sampler sampler = Sampler::Hammersley;
  std::uint64_t seed = 0;
  /// Independent sets that the photons are made of, 1 to 16. Each has its own shift; in every second one the first
  /// two coordinates are exchanged, and so are Hammersley's bases 2 and 3, so that the patterns of two sets are
  /// unrelated.
  int batches = 1;
  /// Where photons are dense; null or empty: spread evenly. A light that it has no square for is spread evenly.
  const ImportanceMap* map = nullptr;
  /// Largest density that the map may ask for, over that of photons spread evenly; at least 1.
  double densestAtMost = 8.0;
  /// Which of so many parts of the photons are made: one after the other, they are all of them in their order.
  int part = 0, parts = 1;
};

/// Photons of all lights, where they enter the volume (those of a lamp in the volume: at the lamp), and the number of
/// each one's light: that in `illumination.lights`, then EnvironmentLight for the environment and the sky, -2 for the
/// faces.
struct EmittedPhotons
{
  std::vector<Photon> photons;
  std::vector<int> lights;
  Rgb power = {};       ///< W, of these photons
  double seconds = 0.0; ///< that it took
};

/// Makes photons of lights (Pfeuti 2009, section 3.1.4; numerics.md, Eq. (94)), in double precision on the host.
/// Photons that would miss the volume are not made, and the power of the others is what really reaches it:
///
///  - directional: spread over the outline of the volume on the photon plane across the light's direction
///  - point: over the solid angle of the faces that the lamp sees, or all around a lamp in the volume; what a lamp on a
///    face, an edge or a corner shines outwards is not made (LampView)
///  - spot: over its cone or what the lamp sees, whichever is smaller; those outside the other one are not made
///  - rectangle: from points of it over the faces that each sees, power by the cosine; in the volume over a half-space;
///    one that is large as seen from the volume over the faces, from each point over the rectangle's solid angle
///  - environment and sky: direction by radiance, solid angle and outline of the volume, then over that outline
///  - faces: over each face, directions by the cosine
///
/// The index outside is taken as constant.
///
/// @throws InvalidInput where an illumination is not valid or photonCount is 0; DeviceError where the machine's
///   memory does not suffice for the photons (60 bytes each); Aborted
EmittedPhotons EmitPhotons(
  const Grid& grid, const Illumination& illumination, const EmissionSettings& settings, const Monitor& monitor = {});

/// Pilot photons of a light.
struct PilotPhotons
{
  int light = 0;                           ///< its number
  std::vector<Photon> photons;             ///< those of edge*edge that reach the volume
  std::vector<std::array<int, 2>> origins; ///< column and row of the cell of its photon plane that each was made in
};

/// Photons of every light, the environment and the sky, not of the faces: one in each cell of a square grid, at a
/// random place in it (Pfeuti 2009, section 3.2.2).
/// @param edge  cells along an edge of the grid, at least 1
/// @throws InvalidInput where an illumination is not valid
std::vector<PilotPhotons> EmitPilots(
  const Grid& grid, const Illumination& illumination, int edge, std::uint64_t seed = 0);
}
