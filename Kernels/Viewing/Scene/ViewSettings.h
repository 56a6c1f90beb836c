#pragma once

#include "Light/Quality.h"
#include "Lights/Lights.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// What a surface of refractive objects reflects of the light that meets it from the side of the smaller index.
enum class SurfaceReflection
{
  None = 0,
  Fresnel = 1, ///< of unpolarised light, for the indices on both sides
  Fixed = 2,
};

/// From a surface, beyond its smoothing (9 voxels wide) by default, to where Fresnel's equations take the indices.
constexpr double VoxelsBesideSurface = 5.0;

/// The names are those of the filter's properties.
struct ViewSettings
{
  std::array<int, 2> imageSize = { 800, 600 }; ///< pixels
  double stepSize = 0.5;                       ///< voxels a ray advances between samples, [0.01, 10]
  bool singleScatteringOnly = false;           ///< show only light that was scattered once
  /// Find the lights' direct light by shadow rays, with the medium's phase function; without lamps and suns nothing
  /// changes.
  bool shadowRays = false;
  int rectangleSamples = 3;                ///< per edge of a rectangular light, for shadow rays
  bool showBackground = true;              ///< also in what surface and table reflect
  Rgb backgroundColor = { 0.0, 0.0, 0.0 }; ///< radiance behind the medium where there is no environment, [0, 1e37]
  bool skipEmptyBricks = true;             ///< leap over what is empty; changes the time and nothing else
  /// Whether to leave out what the scene does not need; false: three channels, rays that could bend and no leaps, to
  /// measure what that saves.
  bool leaveOut = true;
  double minimumTransmittance = 1e-3; ///< a ray that has less left stops; 0: never
  SurfaceReflection surfaceReflection = SurfaceReflection::None;
  double surfaceIndex = 0.0; ///< the surface is where n has this value, > 0; 0: midway between least and largest n
  double surfaceReflectance = 0.1; ///< of SurfaceReflection::Fixed, [0, 1]
  int tableFace = -1; ///< face of the box (-x, +x, -y, +y, -z, +z) that is a table, seen from within; -1: none
  /// Diffuse reflectance of the table, lit by the light in the voxels on it, [0, 1]; at most 1 together with
  /// tableReflectance.
  Rgb tableColor = { 0.6, 0.6, 0.6 };
  double tableReflectance = 0.1; ///< part that the table mirrors, [0, 1]
  int packetWidth = 0; ///< rays marched together: 1, 4, 8 or 16; 0: what the device does best. Changes the time only
};

/// Settings of a quality: the step of rays and the samples of rectangular lights, as far as `settings` has them at
/// their default values.
ViewSettings AtQuality(Quality quality, ViewSettings settings);

/// "Name = value" of each setting that a quality may choose.
std::vector<std::string> Words(const ViewSettings& settings);
}
