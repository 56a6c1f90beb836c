#include "DiscreteOrdinates/OrdinatesQuality.h"

#include "Numerics/NumberText.h"

namespace tyndall
{
namespace
{
/// Numbers of one level.
struct Level
{
  int rows; ///< of directions along a face's edge
  int terms;
  double tolerance;
};

constexpr Level Draft = { 3, 9, 1e-2 }, Fine = { 8, 49, 1e-4 }, Reference = { 12, 100, 1e-5 };

/// Rows of directions whose radiance, one channel of every voxel, takes at most half of the memory.
int RowsThatFit(int rows, int atLeast, std::size_t voxels, const DeviceMemory& memory)
{
  constexpr std::size_t Faces = 6;
  while (rows > atLeast && Faces * rows * rows * sizeof(float) * voxels > memory.all / 2)
  {
    --rows;
  }
  return rows;
}

void SetLevel(
  const Level& level, OrdinatesSettings& settings, const MediumOfQuality& medium, const DeviceMemory& memory)
{
  const OrdinatesSettings byDefault;
  const int rows = RowsThatFit(level.rows, Draft.rows, medium.voxels, memory);
  SetUnlessChosen(settings.directionsPerFace, byDefault.directionsPerFace, rows * rows);
  SetUnlessChosen(settings.tolerance, byDefault.tolerance, level.tolerance);
  if (!medium.isIsotropic)
  {
    SetUnlessChosen(settings.terms, byDefault.terms, level.terms);
  }
}
}

OrdinatesSettings AtQuality(
  Quality quality, OrdinatesSettings settings, const Medium& medium, const DeviceMemory& memory)
{
  return AtQuality(quality, settings, MediumOfQuality{ medium.grid.VoxelCount(), medium.phase.IsIsotropic() }, memory);
}

OrdinatesSettings AtQuality(
  Quality quality, OrdinatesSettings settings, const MediumOfQuality& medium, const DeviceMemory& memory)
{
  switch (quality)
  {
    case Quality::Draft: SetLevel(Draft, settings, medium, memory); break;
    case Quality::Default: break;
    case Quality::Fine: SetLevel(Fine, settings, medium, memory); break;
    case Quality::Reference: SetLevel(Reference, settings, medium, memory); break;
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
