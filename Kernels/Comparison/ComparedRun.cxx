#include "Comparison/ComparedRun.h"

#include "Device/Errors.h"

#include <algorithm>

namespace tyndall
{
const char* NameOf(ComparedMethod method)
{
  switch (method)
  {
    case ComparedMethod::LightPropagationMaps: return "light propagation maps";
    case ComparedMethod::ConstantSource: return "constant source, not accelerated";
    case ComparedMethod::Published: return "as published";
    case ComparedMethod::PublishedSequential: return "as published, sequential";
    case ComparedMethod::DiscreteOrdinates: return "discrete ordinates";
    case ComparedMethod::LatticeBoltzmann: return "lattice Boltzmann";
    case ComparedMethod::Photons: return "photons";
    case ComparedMethod::AdaptivePhotons: return "adaptive photons";
    case ComparedMethod::MonteCarlo: return "Monte Carlo";
    default: return "photons as published";
  }
}

bool IsOfPhotons(ComparedMethod method)
{
  return IsDirectOnly(method) || method == ComparedMethod::MonteCarlo;
}

bool IsDirectOnly(ComparedMethod method)
{
  return method == ComparedMethod::Photons || method == ComparedMethod::AdaptivePhotons ||
    method == ComparedMethod::PublishedPhotons;
}

std::vector<ComparedRun> RunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings)
{
  std::vector<ComparedRun> runs = IsOfPhotons(method) ? PhotonRunsOf(method, device, scene, settings)
    : method == ComparedMethod::LatticeBoltzmann      ? LatticeRunsOf(device, scene, settings)
                                                      : PropagationRunsOf(method, device, scene, settings);
  std::stable_sort(
    runs.begin(), runs.end(), [](const ComparedRun& a, const ComparedRun& b) { return a.cost < b.cost; });
  return runs;
}

namespace
{
void CheckList(const std::vector<int>& values, const char* name, bool mayBeEmpty, int most = 1 << 30)
{
  if (values.empty() && !mayBeEmpty)
  {
    throw InvalidInput(std::string(name) + " is empty: there is nothing to try. Give at least one number.");
  }
  for (int value : values)
  {
    if (value < 1 || value > most)
    {
      throw InvalidInput(std::string(name) + " has " + std::to_string(value) + "; its numbers must be 1 to " +
        std::to_string(most) + ".");
    }
  }
}
}

void Check(const ComparedSettings& settings)
{
  CheckList(settings.directionsPerFace, "Directions", false);
  CheckList(settings.mapResolutions, "MapResolutions", false, 16);
  CheckList(settings.coarsenings, "Coarsenings", false);
  CheckList(settings.orders, "Orders", true);
  CheckList(settings.photonCounts, "PhotonCounts", false);
  if (settings.samplers.empty())
  {
    throw InvalidInput("There is no sampler to try photons by.");
  }
  const int reference = static_cast<int>(settings.monteCarloReference);
  if (reference < 0 || reference > 2)
  {
    throw InvalidInput("MonteCarloReference is " + std::to_string(reference) +
      "; it must be 0 (never), 1 (always) or 2 (where it can beat the methods).");
  }
  PropagationSettings propagation;
  propagation.tolerance = settings.tolerance;
  Check(propagation);
}
}
