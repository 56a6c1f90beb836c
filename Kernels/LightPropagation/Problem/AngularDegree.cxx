#include "LightPropagation/Problem/AngularDegree.h"

#include "LightPropagation/Angular/AngularBasis.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr int MostMoments = 32;     ///< that are looked at
constexpr double Negligible = 1e-3; ///< moment of a phase function
constexpr int DegreeOfSlabs = 9, DegreeOfOthers = 3;
constexpr std::size_t ArraysOfMoments = 4; ///< source, path, what is given, and of uncollided light

/// Largest moments, by degree, of all phase functions of the medium.
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
  const Field& g = medium.phase.G();
  const auto [least, most] = std::minmax_element(g.values, g.values + medium.grid.VoxelCount() * g.components);
  add(medium.phase.OfChannel(0).WithMeanCosine(*least));
  add(medium.phase.OfChannel(0).WithMeanCosine(*most));
  return largest;
}

/// Up to `degree`, such that half of the memory is left for all else.
int HighestThatFits(const Grid& grid, int degree, const DeviceMemory& memory)
{
  constexpr std::size_t MostChannels = 3;
  const auto fits = [&](int l) {
    const std::size_t array = grid.VoxelCount() * MostChannels * sizeof(float) * (l + 1) * (l + 1);
    return array <= memory.one && ArraysOfMoments * array <= memory.all / 2;
  };
  while (degree > 0 && !fits(degree))
  {
    --degree;
  }
  return degree;
}
}

DeviceMemory MemoryOf(const Device& device)
{
  const std::size_t inUse = std::min(device.BytesInUse(), device.MemoryLimit());
  return { device.MemoryLimit() - inUse, device.AllocationLimit() };
}

int AngularDegreeFor(const Medium& medium, const PropagationSettings& settings, bool slab, const DeviceMemory& memory)
{
  const std::vector<double> moments = LargestMoments(medium);
  const auto lastAbove = [&](double negligible) {
    int last = 0;
    for (int l = 1; l <= MostMoments; ++l)
    {
      last = moments[l] > negligible ? l : last;
    }
    return last;
  };
  const int usual = HighestThatFits(medium.grid, slab ? DegreeOfSlabs : DegreeOfOthers, memory);
  const int wanted = settings.angularDegree >= 0 ? settings.angularDegree
                                                 : std::min(usual, lastAbove(std::max(Negligible, settings.tolerance)));
  return wanted == 0 || lastAbove(Negligible) == 0
    ? 0
    : MostDegree(EquiangularDirections(settings.directionsPerFace), wanted);
}
}
