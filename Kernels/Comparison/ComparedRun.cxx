#include "Comparison/ComparedRun.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"
#include "Photons/Photons.h"

#include <algorithm>
#include <cstdlib>

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
    case ComparedMethod::PhotonsThenMaps: return "photons, then maps";
    case ComparedMethod::Photons: return "photons";
    case ComparedMethod::AdaptivePhotons: return "adaptive photons";
    case ComparedMethod::MonteCarlo: return "Monte Carlo";
    case ComparedMethod::Voxelizer: return "voxelizer and photons";
    case ComparedMethod::Pictures: return "picture";
    default: return "photons as published";
  }
}

bool IsOfPhotons(ComparedMethod method)
{
  return QuantityOf(method) == ComparedQuantity::FluenceDirect || method == ComparedMethod::MonteCarlo;
}

ComparedQuantity QuantityOf(ComparedMethod method)
{
  switch (method)
  {
    case ComparedMethod::Photons:
    case ComparedMethod::AdaptivePhotons:
    case ComparedMethod::PublishedPhotons:
    case ComparedMethod::Voxelizer: return ComparedQuantity::FluenceDirect;
    case ComparedMethod::Pictures: return ComparedQuantity::Radiance;
    default: return ComparedQuantity::Fluence;
  }
}

const char* NameOf(ComparedQuantity quantity)
{
  return quantity == ComparedQuantity::Fluence    ? "fluence"
    : quantity == ComparedQuantity::FluenceDirect ? "fluence_direct"
                                                  : "radiance";
}

int UsualDirections(const ComparedSettings& settings)
{
  return *std::min_element(settings.directionsPerFace.begin(), settings.directionsPerFace.end(),
    [](int a, int b) { return std::abs(a - 25) < std::abs(b - 25); });
}

std::vector<ComparedRun> RunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings)
{
  std::vector<ComparedRun> runs = IsOfPhotons(method) ? PhotonRunsOf(method, device, scene, settings)
    : method == ComparedMethod::LatticeBoltzmann      ? LatticeRunsOf(device, scene, settings)
    : method == ComparedMethod::Pictures              ? PictureRunsOf(device, scene)
                                                      : PropagationRunsOf(method, device, scene, settings);
  for (ComparedRun& run : runs)
  {
    if (!scene.suitsEmitter && run.filters.find("PhotonEmitter") != std::string::npos)
    {
      run.filters.clear();
    }
  }
  std::stable_sort(
    runs.begin(), runs.end(), [](const ComparedRun& a, const ComparedRun& b) { return a.cost < b.cost; });
  return runs;
}

namespace
{
/// Checks that all values of a list are in a range.
/// @throws InvalidInput, which names the list and the first value that is not
template <class Number>
void CheckRange(const std::vector<Number>& values, const char* name, double least, double most)
{
  for (Number value : values)
  {
    if (!(value >= least && value <= most))
    {
      throw InvalidInput(std::string(name) + " has " + Text("%.12g", value) + "; its numbers must be " +
        Text("%.12g", least) + " to " + Text("%.12g", most) + ".");
    }
  }
}

void CheckList(const std::vector<int>& values, const char* name, int most = 1 << 30)
{
  Require(!values.empty(), std::string(name) + " is empty: there is nothing to try. Give at least one number.");
  CheckRange(values, name, 1, most);
}

void CheckIntegrators(const ComparedSettings& settings)
{
  CheckRange(settings.octreeTolerances, "OctreeTolerances", 0.0, 1.0);
  MarchSettings marching;
  for (int order : settings.integratorOrders)
  {
    marching.order = order;
    Check(marching);
  }
  for (double step : settings.stepSizes)
  {
    marching.stepSize = step;
    Check(marching);
  }
}
}

void Check(const ComparedSettings& settings)
{
  CheckList(settings.directionsPerFace, "Directions");
  CheckList(settings.mapResolutions, "MapResolutions", 16);
  CheckList(settings.coarsenings, "Coarsenings");
  CheckRange(settings.orders, "Orders", 1, 1 << 30);
  CheckRange(settings.terms, "Terms", 1, 6 * UsualDirections(settings));
  CheckList(settings.photonCounts, "PhotonCounts");
  CheckIntegrators(settings);
  CheckList(settings.supersamplings, "SupersamplingFactors", 16);
  CheckList(settings.filterSizes, "FilterSizes", 65);
  for (int size : settings.filterSizes)
  {
    if (size % 2 == 0)
    {
      throw InvalidInput("FilterSizes has " + std::to_string(size) + "; the width of a filter must be an odd number.");
    }
  }
  Require(!settings.samplers.empty(), "There is no sampler to try photons by.");
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
