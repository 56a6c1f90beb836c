#include "LightPropagation/Problem/AngularDegree.h"

#include "LightPropagation/Angular/AngularBasis.h"
#include "PhaseFunction/PhaseOfMedium.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Highest degree of the phase functions' moments from which the degree of the angular moments is chosen
constexpr int MostMoments = 32;
constexpr double Negligible = 1e-3; ///< magnitude below which a moment of a phase function is neglected
constexpr int DegreeOfSlabs = 9, DegreeOfThin = 6, DegreeOfOthers = 3;
constexpr double SomewhatForward = 0.6;
/// Optical thickness of the box above which singly scattered light is a small fraction of all scattered light.
constexpr double Thick = 8.0;
constexpr double MuchThinner = 8.0;
/// Number of arrays of angular moments that a solve holds: of the source, path integrals, given source (emission and
/// first collisions) and uncollided light.
constexpr std::size_t ArraysOfMoments = 4;

/// Largest magnitude of a moment over all phase functions of the medium, by degree.
std::vector<double> LargestMoments(const Medium& medium)
{
  std::vector<double> largest(MostMoments + 1, 0.0);
  const auto add = [&](const PhaseFunction& function) {
    const std::vector<double> moments = function.Moments(MostMoments);
    for (int l = 0; l <= MostMoments; ++l)
    {
      largest[l] = std::max(largest[l], std::abs(moments[l]));
    }
  };
  if (!medium.phase.Varies())
  {
    add(medium.phase.OfChannel(0));
    add(medium.phase.OfChannel(1));
    add(medium.phase.OfChannel(2));
    return largest;
  }
  const MeanCosineRange range(medium.phase.G(), medium.sigma_s, medium.grid.VoxelCount());
  for (std::size_t c = 0; c < 3; ++c)
  {
    for (const double g : { range.least[c], range.greatest[c] })
    {
      add(medium.phase.OfChannel(0).WithMeanCosine(std::isfinite(g) ? g : 0.0));
    }
  }
  return largest;
}

/// Highest degree, at most `degree`, whose arrays of moments fit in half of the memory; all other arrays need the other
/// half.
int HighestThatFits(std::size_t voxels, int degree, const DeviceMemory& memory)
{
  constexpr std::size_t MostChannels = 3;
  const auto fits = [&](int l) {
    const std::size_t array = voxels * MostChannels * sizeof(float) * (l + 1) * (l + 1);
    return array <= memory.one && ArraysOfMoments * array <= memory.all / 2;
  };
  while (degree > 0 && !fits(degree))
  {
    --degree;
  }
  return degree;
}

/// Highest degree whose moment is larger than `negligible`; 0 if there is none.
int LastAbove(const std::vector<double>& moments, double negligible)
{
  int last = 0;
  for (int l = 1; l <= MostMoments; ++l)
  {
    last = moments[l] > negligible ? l : last;
  }
  return last;
}
}

double SumOfExtinction(const Medium& medium, int channel)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    sum += medium.sigma_a.At(i, channel) + medium.sigma_s.At(i, channel);
  }
  return sum;
}

double MeanThickness(const Grid& grid, double extinction)
{
  return extinction * grid.VoxelVolume() / std::cbrt(std::pow(grid.VoxelCount() * grid.VoxelVolume(), 2));
}

DeviceMemory MemoryOf(const Device& device)
{
  const std::size_t inUse = std::min(device.BytesInUse(), device.MemoryLimit());
  return { device.MemoryLimit() - inUse, device.AllocationLimit() };
}

AngularDetail AngularDetailOf(const Medium& medium, int channels)
{
  AngularDetail detail = { LargestMoments(medium), {} };
  for (int c = 0; c < channels && !medium.phase.IsIsotropic(); ++c)
  {
    detail.extinction[c] = SumOfExtinction(medium, c);
  }
  return detail;
}

int AngularDegreeFor(const AngularDetail& detail, const Grid& grid, const PropagationSettings& settings, bool slab,
  std::size_t voxels, const DeviceMemory& memory)
{
  // In thin media most light is scattered only once. More moments are then used, and a narrower part of the forward
  // peak is treated as unscattered.
  const bool thin = detail.moments[1] > SomewhatForward && MeanThickness(grid, detail.extinction[0]) < Thick;
  const int usual = HighestThatFits(voxels, slab ? DegreeOfSlabs : thin ? DegreeOfThin : DegreeOfOthers, memory);
  const int wanted = settings.angularDegree >= 0
    ? settings.angularDegree
    : std::min(usual, LastAbove(detail.moments, std::max(Negligible, settings.tolerance)));
  return wanted == 0 || LastAbove(detail.moments, Negligible) == 0
    ? 0
    : MostDegree(DirectionsForVoxels(settings.directionsPerFace, grid.spacing), wanted);
}

bool IsMuchThinnerAlongOneAxis(
  const AngularDetail& detail, const Grid& grid, int channels, const std::array<bool, 3>& periodic)
{
  for (int c = 0; c < channels; ++c)
  {
    const double sigma_t = detail.extinction[c] / static_cast<double>(grid.VoxelCount());
    double shortest = std::numeric_limits<double>::max(), longest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double edge = grid.size[axis] * grid.spacing[axis];
      shortest = periodic[axis] ? shortest : std::min(shortest, edge);
      longest = periodic[axis] ? longest : std::max(longest, edge);
    }
    if (longest > MuchThinner * shortest && std::min(sigma_t * longest, 1.0) > MuchThinner * sigma_t * shortest)
    {
      return true;
    }
  }
  return false;
}
}
