#include "Comparison/ConvergedLight.h"

// Computes the reference of a comparison if none is given; see SolverComparison.h.

#include "Comparison/PhotonReference.h"
#include "Device/Errors.h"
#include "Numerics/NumberText.h"

namespace tyndall
{
namespace
{
/// Settings of one candidate for the converged run of light propagation maps. The list Ladder has all candidates, from
/// the most accurate to the cheapest.
struct Rung
{
  int refinement, directions, map;
};
constexpr Rung Ladder[] = { { 2, 256, 2 }, { 2, 256, 1 }, { 2, 144, 1 }, { 1, 256, 2 }, { 1, 144, 2 }, { 1, 144, 1 } };
constexpr double ConvergedTolerance = 1e-6;

std::size_t LargestOf(const std::vector<int>& counts)
{
  return static_cast<std::size_t>(*std::max_element(counts.begin(), counts.end()));
}

Factors RefinementBy(int factor, const Grid& grid)
{
  Factors factors;
  std::transform(grid.size.begin(), grid.size.end(), factors.begin(), [=](int size) { return size == 1 ? 1 : factor; });
  return factors;
}

PropagationSettings SettingsOf(const Rung& rung)
{
  PropagationSettings settings;
  settings.directionsPerFace = rung.directions;
  settings.mapResolution = rung.map;
  settings.tolerance = ConvergedTolerance;
  return settings;
}

std::string InWords(const Rung& rung, const Grid& grid, double seconds)
{
  const auto size = [&](int axis) { return std::to_string(grid.size[axis]); };
  return "light propagation maps, " + std::to_string(rung.directions) + " directions a face, map resolution " +
    std::to_string(rung.map) + ", tolerance " + Text("%g", ConvergedTolerance) + ", " + size(0) + "x" + size(1) + "x" +
    size(2) + " voxels (" +
    (rung.refinement > 1 ? "twice as fine" : "the medium's: what they are too large for is in no figure") + "), " +
    Text("%.3g", seconds) + " s";
}

ReferenceLight AsReference(LightField&& light, const Grid& grid)
{
  ReferenceLight reference;
  reference.grid = grid;
  reference.channels = light.channels;
  reference.fluence = std::move(light.fluence);
  reference.fluenceDirect = std::move(light.fluenceDirect);
  return reference;
}

ReferenceLight Climb(Device& device, const ComparedScene& scene, const Rung& rung, const Monitor& monitor)
{
  const double start = device.Now();
  const DividedScene divided(
    { Domain(scene.medium.grid), scene.medium, scene.illumination }, RefinementBy(rung.refinement, scene.medium.grid));
  ComparedScene fine = scene;
  fine.medium = divided.Scene().medium;
  ReferenceLight reference = AsReference(Propagate(device, fine, SettingsOf(rung), monitor), fine.medium.grid);
  reference.text = InWords(rung, reference.grid, device.Now() - start);
  return reference;
}

/// Predicts run times of converged runs from NominalSeconds (run times per ray and voxel on slow cores) and from the
/// number of sweeps that a run with few directions took.
class Forecast
{
public:
  Forecast(Device& device, const ComparedScene& scene, const Monitor& monitor)
    : VoxelGrid(scene.medium.grid)
  {
    const LightField light = Propagate(device, scene, SettingsOf({ 1, 25, 1 }), monitor);
    this->OfRayVoxel = NominalSeconds::OfRayVoxel * light.channels *
      std::max<double>(1.0, static_cast<double>(light.convergence.size()));
  }

  double Seconds(const Rung& rung) const
  {
    const Factors factors = RefinementBy(rung.refinement, this->VoxelGrid);
    const double rays = 6.0 * rung.directions * rung.map * rung.map;
    return this->OfRayVoxel * rays * static_cast<double>(this->VoxelGrid.VoxelCount()) * factors[0] * factors[1] *
      factors[2];
  }

private:
  Grid VoxelGrid;
  double OfRayVoxel = 0.0;
};

ReferenceLight ByPropagation(Device& device, const ComparedScene& scene, double seconds, const Monitor& monitor)
{
  const Forecast forecast(device, scene, OfPart(monitor, 0.0, 0.2));
  for (const Rung& rung : Ladder)
  {
    const bool last = &rung == std::end(Ladder) - 1;
    if (!last && forecast.Seconds(rung) > seconds)
    {
      continue;
    }
    try
    {
      return Climb(device, scene, rung, OfPart(monitor, 0.2, 1.0));
    }
    catch (const DeviceError&) // the run does not fit the device; a cheaper candidate may
    {
      if (last)
      {
        throw;
      }
    }
  }
  return {}; // never reached, since the last candidate of Ladder returns or throws
}

ReferenceLight ByPhotonsAlways(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor)
{
  const std::string whyNot = scene.WhyNotByPhotons(true);
  Require(whyNot.empty(), "MonteCarloReference cannot be made: " + whyNot + ". Switch it off, or connect a reference.");
  return ReferenceOfPhotons(device, scene, settings, LargestOf(settings.photonCounts), seconds, nullptr, monitor);
}

ReferenceLight ByWhatIsBetter(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor)
{
  const std::string whyNot = scene.WhyNotByPhotons(true);
  if (!whyNot.empty())
  {
    ReferenceLight reference = ByPropagation(device, scene, seconds, monitor);
    reference.text += "; not photons: " + whyNot;
    return reference;
  }
  constexpr double toForecast = 0.3; // progress that is reported when the forecast is complete, in [0, 1]
  const PhotonForecast forecast = ForecastOfPhotons(device, scene, settings, seconds, OfPart(monitor, 0.0, toForecast));
  const LightField* const maps = forecast.maps ? &*forecast.maps : nullptr;
  const Monitor rest = OfPart(monitor, toForecast, 1.0);
  ReferenceLight reference = forecast.beats
    ? ReferenceOfPhotons(device, scene, settings, forecast.photonsOfASet, 0.0, maps, rest)
    : ByPropagation(device, scene, (1.0 - forecast.PartOfTime) * seconds, rest);
  reference.text += "; " + forecast.why;
  return reference;
}
}

ReferenceLight ConvergedLight(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor)
{
  if (scene.BendsLight())
  {
    return ReferenceOfPhotons(device, scene, settings, LargestOf(settings.photonCounts), seconds, nullptr, monitor);
  }
  ComparedSettings scattering = settings;
  scattering.scattersReference = true;
  switch (settings.monteCarloReference)
  {
    case MonteCarloReference::Always: return ByPhotonsAlways(device, scene, scattering, seconds, monitor);
    case MonteCarloReference::WhereItCanBeat: return ByWhatIsBetter(device, scene, scattering, seconds, monitor);
    default: return ByPropagation(device, scene, seconds, monitor);
  }
}
}
