#include "LightPropagation/Problem/PropagationQuality.h"

#include "LightPropagation/Problem/AngularDegree.h"
#include "Medium/VoxelSums.h"
#include "Numerics/NumberText.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Optical thickness of a box above which few directions suffice for scattered light.
constexpr double ThickBox = 8.0;

/// Values of settings at one quality level.
struct Level
{
  int directions, directionsInThickBox;
  /// Directions per cube face for uncollided light, used if light is incident through the box's faces.
  int uncollidedDirections;
  double tolerance, emissionError;
};

/// Properties of a scene that a quality level depends on.
struct SceneOfQuality
{
  /// isLit: whether light is incident through the box's faces; scatters: whether any voxel scatters
  bool isLit, scatters;
  double thickness; ///< mean optical thickness of the box
};

bool Scatters(const Medium& medium)
{
  const std::size_t count = medium.grid.VoxelCount() * medium.sigma_s.components;
  return medium.sigma_s.values &&
    std::any_of(medium.sigma_s.values, medium.sigma_s.values + count, [](float value) { return value > 0.0f; });
}

constexpr Level Draft = { 9, 9, 0, 1e-2, 0.05 };
constexpr Level Fine = { 64, 49, 400, 1e-4, 0.01 };
constexpr Level Reference = { 256, 144, 1600, 1e-5, 0.005 };
constexpr int Staggered = 144; ///< minimum number of directions per face for which staggered ray starts halve the error

void SetLevel(const Level& level, PropagationSettings& settings, const SceneOfQuality& scene)
{
  const PropagationSettings byDefault;
  const bool lit = scene.isLit, scatters = scene.scatters;
  const int ofScattered = scene.thickness < ThickBox ? level.directions : level.directionsInThickBox;
  const int directions = scatters || !lit ? ofScattered : std::max(ofScattered, level.uncollidedDirections);
  SetUnlessChosen(settings.directionsPerFace, byDefault.directionsPerFace, directions);
  SetUnlessChosen(settings.uncollidedDirections, byDefault.uncollidedDirections,
    lit && scatters && level.uncollidedDirections > settings.directionsPerFace ? level.uncollidedDirections : 0);
  SetUnlessChosen(settings.staggeredRays, byDefault.staggeredRays, settings.directionsPerFace >= Staggered);
  SetUnlessChosen(settings.tolerance, byDefault.tolerance, level.tolerance);
  SetUnlessChosen(settings.emissionError, byDefault.emissionError, level.emissionError);
}
}

PropagationSettings AtQuality(const Domain& domain, Quality quality, PropagationSettings settings, const Medium& medium,
  const Illumination& illumination)
{
  if (quality == Quality::Default)
  {
    return settings;
  }
  // Without angular moments the solver uses the extinction of the similarity relation, sigma_a + sigma_s (1 - g).
  const double own = domain.IsEmpty() ? 0.0
    : settings.angularDegree == 0
    ? SumOverVoxels(medium.grid, [&](std::size_t i) { return double(medium.TransportSigmaT(i, 0)); })
    : SumOfExtinction(medium, 0);
  const double extinction = domain.Sum(own);
  const SceneOfQuality scene = { ShinesThroughFaces(illumination), domain.Any(!domain.IsEmpty() && Scatters(medium)),
    MeanThickness(domain.Whole(), extinction) };
  SetLevel(quality == Quality::Draft ? Draft : quality == Quality::Fine ? Fine : Reference, settings, scene);
  return settings;
}

std::vector<std::string> Words(const PropagationSettings& settings)
{
  return { "DirectionsPerFace = " + std::to_string(settings.directionsPerFace),
    "UncollidedDirections = " + std::to_string(settings.uncollidedDirections),
    "MapResolution = " + std::to_string(settings.mapResolution),
    "StaggeredRays = " + std::to_string(settings.staggeredRays ? 1 : 0),
    "Tolerance = " + Text("%g", settings.tolerance), "EmissionError = " + Text("%g", settings.emissionError) };
}

std::vector<std::string> Words(PropagationSettings settings, const LightField& light)
{
  if (light.polarNodes > 0)
  {
    return { "PolarNodes = " + std::to_string(light.polarNodes) };
  }
  settings.directionsPerFace = light.directionsPerFace > 0 ? light.directionsPerFace : settings.directionsPerFace;
  settings.uncollidedDirections = light.uncollidedDirections;
  return Words(settings);
}

std::vector<std::string> WordsAsPublished(const PropagationSettings& settings)
{
  return { "DirectionsPerFace = " + std::to_string(settings.directionsPerFace),
    "MapResolution = " + std::to_string(settings.mapResolution), "Tolerance = " + Text("%g", settings.tolerance) };
}
}
