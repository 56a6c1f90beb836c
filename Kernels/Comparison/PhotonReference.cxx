#include "Comparison/PhotonReference.h"

#include "Comparison/MeansOfSets.h"
#include "Comparison/TimeLimit.h"
#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tyndall
{
namespace
{
constexpr int FewestSets = 16, MostSets = 64;
constexpr int FewestToForecast = 4, MostToForecast = 64;           ///< sets
constexpr std::size_t PartToForecast = 16, LeastToForecast = 1000; ///< photons of a set
constexpr std::size_t MostOfASet = std::size_t{ 1 } << 21;         ///< a hundred megabytes
constexpr double PartOfTime = 0.25;                                ///< for the maps, and for photons, to forecast by
constexpr double Beats = 1.0 / 3.0; ///< error of the reference over that of the best method compared
constexpr double Enough = 0.1;      ///< the same, of sixteen sets

/// The finest maps that are tried, or few directions where these take too long or do not fit; none where these do,
/// too.
std::optional<LightField> FinestMaps(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor)
{
  const double end = ClockSeconds() + seconds;
  PropagationSettings finest, coarse;
  finest.directionsPerFace = *std::max_element(settings.directionsPerFace.begin(), settings.directionsPerFace.end());
  finest.mapResolution = finest.directionsPerFace < FewestForFinerMaps
    ? 1
    : *std::max_element(settings.mapResolutions.begin(), settings.mapResolutions.end());
  coarse.directionsPerFace = std::min(coarse.directionsPerFace, finest.directionsPerFace);
  finest.tolerance = coarse.tolerance = settings.tolerance;
  double done = 0.5, until = end - 0.3 * seconds;
  for (const PropagationSettings& maps : { finest, coarse })
  {
    try
    {
      return Propagate(device, scene, maps, PartWithin(until - ClockSeconds(), monitor, done, done + 0.25));
    }
    catch (const TimeIsUp&)
    {
    }
    catch (const DeviceError&)
    {
    }
    done += 0.25;
    until = end;
  }
  return std::nullopt;
}

/// A few photons, to forecast by.
struct Pilot
{
  MeansOfSets means;
  std::size_t photons = 0; ///< of a set
  double seconds = 0.0;    ///< of a photon
};

Pilot FewPhotons(
  Device& device, const ComparedScene& scene, std::size_t largest, double seconds, const Monitor& monitor)
{
  MarchEvenly(device, scene, LeastToForecast, 0, 1, PartWithin(seconds, monitor, 0.0, 0.1)); // compiles
  const double begun = ClockSeconds();
  Pilot pilot;
  pilot.photons = std::max(largest / PartToForecast, LeastToForecast);
  const auto march = [&](int seed) {
    const double all = MostToForecast + 1.0, left = seconds - (ClockSeconds() - begun);
    const Monitor part = PartWithin(seed > FewestToForecast ? HUGE_VAL : left, monitor, seed / all, (seed + 1) / all);
    return MarchEvenly(device, scene, pilot.photons, 0, static_cast<std::uint64_t>(seed) + 1, part);
  };
  const auto goesOn = [&](int sets) {
    return sets < FewestToForecast || (sets < MostToForecast && ClockSeconds() - begun < seconds);
  };
  while (goesOn(pilot.means.Count()))
  {
    const LightField light = march(pilot.means.Count() + 1);
    pilot.means.Add(light.fluence, light.channels);
  }
  pilot.seconds = (ClockSeconds() - begun) / (static_cast<double>(pilot.photons) * pilot.means.Count());
  return pilot;
}
}

ReferenceLight ReferenceOfPhotons(Device& device, const ComparedScene& scene, const ComparedSettings& settings,
  std::size_t set, double seconds, const LightField* maps, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const bool all = settings.scattersReference;
  MeansOfSets fluence, direct;
  const auto goesOn = [&](int sets) {
    return sets < MostSets && (sets < FewestSets || ClockSeconds() - start < seconds);
  };
  while (goesOn(fluence.Count()))
  {
    const int count = fluence.Count();
    const Monitor part = PartWithin(HUGE_VAL, monitor, 1.0 * count / MostSets, (count + 1.0) / MostSets);
    const LightField light = MarchEvenly(device, scene, set, all ? 0 : 1, static_cast<std::uint64_t>(count) + 1, part);
    fluence.Add(light.fluence, light.channels);
    direct.Add(all ? light.fluenceDirect : light.fluence, light.channels);
  }
  ReferenceLight reference;
  reference.grid = scene.medium.grid;
  reference.channels = fluence.Channels();
  reference.fluence = all ? fluence.Values() : std::vector<float>();
  reference.fluenceDirect = direct.Values();
  char text[160];
  std::snprintf(text, sizeof(text), "%d times %zu photons%s, not filtered, standard error %.2g, %.3g s",
    fluence.Count(), set, all ? " that are scattered until they end" : "", fluence.RelativeError(),
    ClockSeconds() - start);
  reference.text = text;
  if (maps && maps->channels == reference.channels &&
    direct.SquaredErrorOf(maps->fluenceDirect, maps->channels) <= direct.Variance())
  {
    reference.fluenceDirect = maps->fluenceDirect;
    reference.text += " (unscattered light: of the finest maps compared, which have no noise)";
  }
  return reference;
}

PhotonForecast ForecastOfPhotons(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor)
{
  const double start = ClockSeconds();
  PhotonForecast forecast;
  Pilot pilot;
  try
  {
    const int largest = *std::max_element(settings.photonCounts.begin(), settings.photonCounts.end());
    pilot = FewPhotons(
      device, scene, static_cast<std::size_t>(largest), PartOfTime * seconds, PartWithin(HUGE_VAL, monitor, 0.0, 0.5));
  }
  catch (const TimeIsUp&)
  {
    forecast.why = "not photons: they are scattered too often for the time";
    return forecast;
  }
  forecast.maps = FinestMaps(device, scene, settings, PartOfTime * seconds, monitor);
  const double left = seconds - (ClockSeconds() - start), all = pilot.means.SumOfSquares();
  const double made = static_cast<double>(pilot.photons) * pilot.means.Count();
  const double ofMade = pilot.means.RelativeError();
  const double ofMaps = !forecast.maps ? HUGE_VAL
    : all > 0.0 ? std::sqrt(pilot.means.SquaredErrorOf(forecast.maps->fluence, forecast.maps->channels) / all)
                : 0.0;
  const double affordable = std::min(std::max(left / pilot.seconds, 1.0), 1.0 * FewestSets * MostOfASet);
  forecast.beats = all > 0.0 && ofMade * std::sqrt(made / affordable) <= Beats * ofMaps;
  const double wanted = forecast.maps ? made * std::pow(ofMade / (Enough * ofMaps), 2) : affordable;
  const double photons = forecast.beats ? std::min(affordable, std::max(wanted, 1.0 * LeastToForecast)) : affordable;
  forecast.photonsOfASet = static_cast<std::size_t>(std::ceil(photons / FewestSets));
  forecast.why = (forecast.beats ? "photons: their standard error was forecast to be "
                                 : "not photons: their standard error would be about ") +
    Text("%.2g", ofMade * std::sqrt(made / photons)) +
    (forecast.maps ? ", the finest maps compared are off by at least " + Text("%.2g", ofMaps)
                   : ", and maps take too long or do not fit");
  return forecast;
}
}
