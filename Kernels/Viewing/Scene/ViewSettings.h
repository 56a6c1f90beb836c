#pragma once

#include "Light/Quality.h"
#include "Lights/Lights.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Reflectance of the surface of a refractive object, for light from the side of the smaller index.
enum class SurfaceReflection
{
  None = 0,
  Fresnel = 1, ///< unpolarised light, from the indices on both sides
  Fixed = 2,
};

/// Distance in voxels from the surface at which Fresnel's equations take the indices: outside the surface's smoothing,
/// which is 9 voxels wide by default.
constexpr double VoxelsBesideSurface = 5.0;

/// Settings of the ray caster, named as the filter's properties.
struct ViewSettings
{
  std::array<int, 2> imageSize = { 800, 600 }; ///< pixels
  double stepSize = 0.5;                       ///< voxels a ray advances between samples, [0.01, 10]
  bool singleScatteringOnly = false;           ///< show only light that was scattered exactly once
  /// Compute the lights' direct light by shadow rays, with the medium's phase function; no effect without lamps and
  /// suns.
  bool shadowRays = false;
  int rectangleSamples = 3;                ///< samples along each edge of a rectangular light, for shadow rays
  bool showBackground = true;              ///< also in reflections by surface and table
  Rgb backgroundColor = { 0.0, 0.0, 0.0 }; ///< radiance behind the medium where there is no environment, [0, 1e37]
  bool skipEmptyBricks = true;             ///< skip empty bricks; changes only the run time
  /// Whether to omit features that the scene does not need. false: always three channels, rays that may bend, and no
  /// skipping of bricks, to measure the savings.
  bool leaveOut = true;
  double minimumTransmittance = 1e-3; ///< rays stop below this transmittance; 0: never
  SurfaceReflection surfaceReflection = SurfaceReflection::None;
  /// refractive index at which the surface lies, > 0; 0: midway between smallest and largest index
  double surfaceIndex = 0.0;
  double surfaceReflectance = 0.1; ///< for SurfaceReflection::Fixed, [0, 1]
  int tableFace = -1; ///< face of the box (0 to 5: -x, +x, -y, +y, -z, +z) that is a table, seen from inside; -1: none
  /// Diffuse reflectance of the table, which is lit by the light in the voxels on it, [0, 1]; the sum with
  /// tableReflectance is at most 1.
  Rgb tableColor = { 0.6, 0.6, 0.6 };
  double tableReflectance = 0.1; ///< specular reflectance of the table, [0, 1]
  /// rays marched together: 1, 4, 8 or 16; 0: the fastest on the device. Changes only the run time
  int packetWidth = 0;
};

/// @throws InvalidInput for a setting that is invalid in every scene
void Check(const ViewSettings& settings);

/// Sets the ray step and the samples of rectangular lights according to a quality, unless `settings` changes them from
/// their defaults.
ViewSettings AtQuality(Quality quality, ViewSettings settings);

/// "Name = value" for each setting that a quality may choose.
std::vector<std::string> Words(const ViewSettings& settings);
}
