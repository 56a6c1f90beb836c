#include "Refraction/Octree/OctreeQuantities.h"

#include "Device/Errors.h"
#include "Device/HostThreads.h"
#include "Numerics/NumberText.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <string>

namespace tyndall
{
namespace
{
std::array<int, 3> Plus(const std::array<int, 3>& a, const std::array<int, 3>& b)
{
  return { a[0] + b[0], a[1] + b[1], a[2] + b[2] };
}

/// The float for which float <= AsBound(bound) says the same as float <= bound.
float AsBound(double bound)
{
  const float nearest = static_cast<float>(bound);
  return nearest > bound ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}
}

void Check(const OctreeSettings& settings)
{
  if (!(settings.tolerance >= 0.0 && settings.tolerance <= 1.0))
  {
    throw InvalidInput("Tolerance is " + Text("%g", settings.tolerance) + "; it must lie in [0, 1].");
  }
  if (!(settings.extinctionTolerance >= 0.0) || std::isinf(settings.extinctionTolerance))
  {
    throw InvalidInput(
      "ExtinctionTolerance is " + Text("%g", settings.extinctionTolerance) + "; it must be finite and not negative.");
  }
}

void CheckIndex(const Field& index, const Grid& grid, const Grid& whole, const std::array<int, 3>& first)
{
  if (!index.values || index.components != 1)
  {
    throw InvalidInput("The refractive index must be given, with one component a voxel.");
  }
  const std::size_t count = grid.VoxelCount();
  std::atomic<bool> good(true);
  InThreads(count, 65536, [&](std::size_t begin, std::size_t end) {
    bool all = true;
    for (std::size_t i = begin; i < end; ++i)
    {
      all &= index.values[i] > 0.0f && index.values[i] <= std::numeric_limits<float>::max();
    }
    if (!all)
    {
      good = false;
    }
  });
  for (std::size_t i = 0; !good && i < count; ++i)
  {
    if (!(index.values[i] > 0.0f) || std::isinf(index.values[i]))
    {
      throw InvalidInput("The refractive index is " + Text("%g", index.values[i]) + " in voxel " +
        VoxelName(whole, whole.IndexOf(Plus(grid.VoxelAt(i), first))) +
        " (the first such voxel); it must be finite and above 0. Clean the input, for example with a "
        "Calculator.");
    }
  }
}

std::vector<float> IndexTolerances(int levelCount, double tolerance)
{
  return std::vector<float>(static_cast<std::size_t>(levelCount), AsBound(tolerance));
}

std::vector<float> ExtinctionTolerances(const Grid& grid, int levelCount, double tolerance)
{
  const double diagonal = std::hypot(grid.spacing[0], grid.spacing[1], grid.spacing[2]);
  std::vector<float> tolerances;
  for (int level = 0; level < levelCount; ++level)
  {
    tolerances.push_back(AsBound(tolerance / std::ldexp(diagonal, level)));
  }
  return tolerances;
}

int ExtinctionChannels(const Medium& medium, const OctreeSettings& settings)
{
  const bool coloured = medium.sigma_a.components == 3 || medium.sigma_s.components == 3;
  return !settings.includeExtinction ? 0 : coloured ? 3 : 1;
}

std::vector<float> Extinction(const Medium& medium, int channel)
{
  std::vector<float> extinction(medium.grid.VoxelCount());
  for (std::size_t i = 0; i < extinction.size(); ++i)
  {
    extinction[i] = medium.sigma_a.At(i, channel) + medium.sigma_s.At(i, channel);
  }
  return extinction;
}
}
