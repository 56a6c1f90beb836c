#pragma once

#include "Light/Quality.h"
#include "Lights/Lights.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Reflectance of the surface of a refractive object, for light incident from the medium of smaller index.
enum class SurfaceReflection
{
  None = 0,
  Fresnel = 1, ///< reflectance for unpolarised light, from the indices on both sides of the surface
  Fixed = 2,
};

/// Distance in voxels from the surface at which Fresnel's equations read the refractive index on either side. It lies
/// outside the smoothed surface layer, which is 9 voxels wide by default.
constexpr double VoxelsBesideSurface = 5.0;

/// Settings of the ray caster, named as the filter's properties.
struct ViewSettings
{
  std::array<int, 2> imageSize = { 800, 600 }; ///< width and height of the picture, pixels
  double stepSize = 0.5;                       ///< distance that a ray advances between samples, voxels, [0.01, 20]
  bool singleScatteringOnly = false;           ///< whether to show only light that was scattered exactly once
  /// Whether to compute direct light by shadow rays to the lights, with the medium's phase function; no effect without
  /// lamps and suns.
  bool shadowRays = false;
  int rectangleSamples = 3;   ///< samples along each edge of a rectangular light, for shadow rays
  bool showBackground = true; ///< whether the background is shown, also in reflections by surface and table
  /// Radiance behind the medium if there is no environment, W / (length^2 sr), [0, 1e37].
  Rgb backgroundColor = { 0.0, 0.0, 0.0 };
  bool skipEmptyBricks = true; ///< whether rays skip empty bricks; changes only the run time
  /// Whether to leave out work that the scene does not need. False, to measure the savings: always three channels, rays
  /// that may bend, and no skipping of bricks.
  bool leaveOut = true;
  double minimumTransmittance = 1e-3; ///< transmittance below which rays stop; 0: they do not stop
  SurfaceReflection surfaceReflection = SurfaceReflection::None;
  /// Refractive index at which the surface lies, > 0; 0: mean of the smallest and the largest index.
  double surfaceIndex = 0.0;
  double surfaceReflectance = 0.1; ///< reflectance of the surface with SurfaceReflection::Fixed, [0, 1]
  /// Face of the box (0 to 5: -x, +x, -y, +y, -z, +z) that is a table: rays from inside the box see its diffuse and
  /// specular reflection. -1: no table.
  int tableFace = -1;
  /// Diffuse reflectance of the table, which the light in the adjacent voxels illuminates, [0, 1]; the sum with
  /// tableReflectance is at most 1.
  Rgb tableColor = { 0.6, 0.6, 0.6 };
  double tableReflectance = 0.1; ///< specular reflectance of the table, [0, 1]
  /// Number of rays marched together: 1, 4, 8 or 16; 0: the fastest on the device. Changes only the run time.
  int packetWidth = 0;
};

/// Checks settings independently of a scene.
/// @throws InvalidInput for a setting that is invalid in every scene
void Check(const ViewSettings& settings);

/// Settings that a quality level chooses: step size, samples of rectangular lights, and transmittance at which rays
/// stop. A setting that differs from its default in `settings` is kept.
ViewSettings AtQuality(Quality quality, ViewSettings settings);

/// Text "Name = value" for each setting that AtQuality may choose.
std::vector<std::string> Words(const ViewSettings& settings);
}
