#include "Comparison/ConvergedLight.h"

// The reference that a comparison makes itself: see SolverComparison.h.

#include "Comparison/PhotonReference.h"
#include "Comparison/TimeLimit.h"
#include "Device/Errors.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tyndall
{
namespace
{
/// Settings to converge with, best first.
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
  char text[256];
  std::snprintf(text, sizeof(text),
    "light propagation maps, %d directions a face, map resolution %d, tolerance %g, %dx%dx%d voxels (%s), %.3g s",
    rung.directions, rung.map, ConvergedTolerance, grid.size[0], grid.size[1], grid.size[2],
    rung.refinement > 1 ? "twice as fine" : "the medium's: what they are too large for is in no figure", seconds);
  return text;
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
  const double start = ClockSeconds();
  const RescaledScene fine(scene, RescaledScene::To::Finer, RefinementBy(rung.refinement, scene.medium.grid));
  ReferenceLight reference =
    AsReference(Propagate(device, fine.Scene(), SettingsOf(rung), monitor), fine.Scene().medium.grid);
  reference.text = InWords(rung, reference.grid, ClockSeconds() - start);
  return reference;
}

/// Seconds that settings take, from two poorer ones: a part for what does not depend on the rays, and one for each ray.
class Forecast
{
public:
  Forecast(Device& device, const ComparedScene& scene, const Monitor& monitor)
    : VoxelGrid(scene.medium.grid)
  {
    constexpr Rung few = { 1, 25, 1 }, more = { 1, 100, 1 };
    const auto run = [&](const Rung& rung, double from, double to) {
      const double start = ClockSeconds();
      Propagate(device, scene, SettingsOf(rung), PartWithin(HUGE_VAL, monitor, from, to));
      return ClockSeconds() - start;
    };
    run(few, 0.0, 0.2); // compiles
    const double ofFew = run(few, 0.2, 0.4), ofMore = run(more, 0.4, 1.0);
    this->OfRay = std::max(ofMore - ofFew, 0.1 * ofMore) / (Rays(more) - Rays(few));
    this->Fixed = std::max(0.0, ofMore - this->OfRay * Rays(more));
  }

  double Seconds(const Rung& rung) const
  {
    const Factors factors = RefinementBy(rung.refinement, this->VoxelGrid);
    return (this->Fixed + this->OfRay * Rays(rung)) * factors[0] * factors[1] * factors[2];
  }

private:
  static double Rays(const Rung& rung) { return 1.0 * rung.directions * rung.map * rung.map; }

  Grid VoxelGrid;
  double OfRay = 0.0, Fixed = 0.0;
};

ReferenceLight ByPropagation(Device& device, const ComparedScene& scene, double seconds, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const Forecast forecast(device, scene, PartWithin(HUGE_VAL, monitor, 0.0, 0.2));
  for (const Rung& rung : Ladder)
  {
    const bool last = &rung == std::end(Ladder) - 1;
    const double left = seconds - (ClockSeconds() - start);
    if (!last && forecast.Seconds(rung) > left)
    {
      continue;
    }
    try
    {
      return Climb(device, scene, rung, PartWithin(last ? HUGE_VAL : left, monitor, 0.2, 1.0));
    }
    catch (const TimeIsUp&)
    {
    }
    catch (const DeviceError&) // too large; a lower rung may do
    {
      if (last)
      {
        throw;
      }
    }
  }
  return {}; // not reached: the last rung has all the time it needs
}

ReferenceLight ByPhotonsAlways(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor)
{
  const std::string whyNot = scene.WhyNotByPhotons(true);
  if (!whyNot.empty())
  {
    throw InvalidInput("MonteCarloReference cannot be made: " + whyNot + ". Switch it off, or connect a reference.");
  }
  return ReferenceOfPhotons(device, scene, settings, LargestOf(settings.photonCounts), seconds, nullptr, monitor);
}

ReferenceLight ByWhatIsBetter(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const std::string whyNot = scene.WhyNotByPhotons(true);
  if (!whyNot.empty())
  {
    ReferenceLight reference = ByPropagation(device, scene, seconds, monitor);
    reference.text += "; not photons: " + whyNot;
    return reference;
  }
  constexpr double toForecast = 0.3; // of the progress
  const PhotonForecast forecast =
    ForecastOfPhotons(device, scene, settings, seconds, PartWithin(HUGE_VAL, monitor, 0.0, toForecast));
  const LightField* const maps = forecast.maps ? &*forecast.maps : nullptr;
  const double left = seconds - (ClockSeconds() - start);
  const Monitor rest = PartWithin(HUGE_VAL, monitor, toForecast, 1.0);
  ReferenceLight reference = forecast.beats
    ? ReferenceOfPhotons(device, scene, settings, forecast.photonsOfASet, 0.0, maps, rest)
    : ByPropagation(device, scene, left, rest);
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
