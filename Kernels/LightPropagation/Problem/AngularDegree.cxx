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
constexpr double SomewhatForward = 0.6;
constexpr int DegreeOfSlabs = 9, DegreeOfForward = 5, DegreeOfOthers = 3;

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
}

int AngularDegreeFor(const Medium& medium, const PropagationSettings& settings, bool slab)
{
  const std::vector<double> moments = LargestMoments(medium);
  int needed = 0; // the last moment that is not negligible
  for (int l = 1; l <= MostMoments; ++l)
  {
    needed = moments[l] > Negligible ? l : needed;
  }
  const int usual = slab ? DegreeOfSlabs : moments[1] > SomewhatForward ? DegreeOfForward : DegreeOfOthers;
  const int wanted = settings.angularDegree >= 0 ? settings.angularDegree : std::min(usual, needed);
  return wanted == 0 || needed == 0 ? 0 : MostDegree(EquiangularDirections(settings.directionsPerFace), wanted);
}
}
