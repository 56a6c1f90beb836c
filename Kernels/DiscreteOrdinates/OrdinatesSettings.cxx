#include "DiscreteOrdinates/OrdinatesSettings.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include <cmath>

namespace tyndall
{
void Check(const OrdinatesSettings& settings)
{
  if (settings.spiralDirections < 0)
  {
    throw InvalidInput("SpiralDirections is " + std::to_string(settings.spiralDirections) +
      "; give 16 at least, or 0 for the directions of a cube.");
  }
  if (settings.terms < 1)
  {
    throw InvalidInput("Terms is " + std::to_string(settings.terms) + "; it must be at least 1.");
  }
  CheckOrders(settings.maximumOrders, settings.tolerance);
}

bool IsPublished(const OrdinatesSettings& settings)
{
  return settings.scheme == OrdinatesScheme::Published;
}

PropagationSettings AsPropagation(const OrdinatesSettings& settings)
{
  PropagationSettings as;
  as.directionsPerFace = settings.directionsPerFace;
  as.adaptDirections = settings.adaptDirections && !IsPublished(settings) && settings.spiralDirections == 0;
  as.source = IsPublished(settings) ? PropagationSource::Constant : PropagationSource::Automatic;
  as.maximumOrders = settings.maximumOrders;
  as.tolerance = settings.tolerance;
  as.periodic = settings.periodic;
  as.netFlux = settings.netFlux;
  as.leaveOut = settings.leaveOut;
  as.acceleration = settings.acceleration;
  as.angularDegree = 0; // no angular moments: the radiance of each direction is scattered into all directions
  as.uncollidedDirections = IsPublished(settings) ? 0 : settings.uncollidedDirections;
  as.alongRays = false;
  as.storeMoments = false;
  return as;
}

namespace
{
/// Settings of one quality level.
struct Level
{
  int rows; ///< directions along the edge of a cube face
  int terms;
  double tolerance;
};

constexpr Level Draft = { 3, 9, 1e-2 }, Fine = { 8, 49, 1e-4 }, Reference = { 12, 100, 1e-5 };

/// Sets the settings of a quality level.
/// @param directions  number of directions per cube face
void SetLevel(const Level& level, OrdinatesSettings& settings, int directions, bool isIsotropic)
{
  const OrdinatesSettings byDefault;
  SetUnlessChosen(settings.directionsPerFace, byDefault.directionsPerFace, directions);
  SetUnlessChosen(settings.tolerance, byDefault.tolerance, level.tolerance);
  if (!isIsotropic)
  {
    SetUnlessChosen(settings.terms, byDefault.terms, level.terms);
  }
}
}

int DirectionsThatFit(const Domain& domain, int most, const DeviceMemory& memory)
{
  constexpr std::size_t Faces = 6;
  const double bytes = -domain.Max(-static_cast<double>(memory.all)); // least of all ranks
  const std::size_t voxels = domain.Whole().VoxelCount();
  int rows = static_cast<int>(std::lround(std::sqrt(static_cast<double>(most))));
  while (rows > Draft.rows && static_cast<double>(Faces * rows * rows * sizeof(float) * voxels) > 0.5 * bytes)
  {
    --rows;
  }
  return rows * rows;
}

OrdinatesSettings AtQuality(
  const Domain& domain, Quality quality, OrdinatesSettings settings, const Medium& medium, const DeviceMemory& memory)
{
  const bool isIsotropic = !domain.Any(!domain.IsEmpty() && !medium.phase.IsIsotropic());
  const auto set = [&](const Level& level) {
    SetLevel(level, settings, DirectionsThatFit(domain, level.rows * level.rows, memory), isIsotropic);
  };
  switch (quality)
  {
    case Quality::Draft: set(Draft); break;
    case Quality::Default: break;
    case Quality::Fine: set(Fine); break;
    case Quality::Reference: set(Reference); break;
  }
  return settings;
}

std::vector<std::string> Words(const OrdinatesSettings& settings)
{
  std::vector<std::string> words = { settings.spiralDirections > 0
      ? "SpiralDirections = " + std::to_string(settings.spiralDirections)
      : "DirectionsPerFace = " + std::to_string(settings.directionsPerFace) };
  if (settings.scattering != OrdinatesScattering::Matrix)
  {
    words.push_back("Terms = " + std::to_string(settings.terms));
  }
  words.push_back("Tolerance = " + Text("%g", settings.tolerance));
  return words;
}

std::vector<std::string> Words(OrdinatesSettings settings, const LightField& light)
{
  settings.directionsPerFace = light.directionsPerFace > 0 ? light.directionsPerFace : settings.directionsPerFace;
  return Words(settings);
}
}
