#include "Comparison/PhotonReference.h"

#include "Comparison/TimeLimit.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

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

/// Means of independent sets of photons, and how far they are off.
class Means
{
public:
  void Add(const std::vector<float>& values)
  {
    this->Sums.resize(values.size());
    this->Squares.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      this->Sums[i] += values[i];
      this->Squares[i] += static_cast<double>(values[i]) * values[i];
    }
    ++this->Count;
  }

  std::vector<float> Values() const
  {
    std::vector<float> means(this->Sums.size());
    std::transform(this->Sums.begin(), this->Sums.end(), means.begin(),
      [this](double sum) { return static_cast<float>(sum / this->Count); });
    return means;
  }

  /// Sum of the squares of the standard errors; needs two sets.
  double Variance() const
  {
    double variance = 0.0;
    for (std::size_t i = 0; i < this->Sums.size(); ++i)
    {
      const double mean = this->Sums[i] / this->Count;
      variance += std::max(0.0, this->Squares[i] / this->Count - mean * mean) / (this->Count - 1);
    }
    return variance;
  }

  double SumOfSquares() const
  {
    return std::accumulate(this->Sums.begin(), this->Sums.end(), 0.0,
      [this](double sum, double values) { return sum + values * values / this->Count / this->Count; });
  }

  /// Root of the mean square of the standard errors, over that of the values.
  double RelativeError() const
  {
    const double squares = this->SumOfSquares();
    return squares > 0.0 ? std::sqrt(this->Variance() / squares) : 0.0;
  }

  int Count = 0;

private:
  std::vector<double> Sums, Squares;
};

/// Sum of the squared differences from light of `ofA` channels; that of one channel stands for all.
double SquaredDistance(const std::vector<float>& a, int ofA, const std::vector<float>& b, int ofB)
{
  const int channels = std::max(ofA, ofB);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size() / static_cast<std::size_t>(ofA); ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      const double difference = static_cast<double>(a[i * ofA + c % ofA]) - b[i * ofB + c % ofB];
      sum += difference * difference * ofA / channels;
    }
  }
  return sum;
}

/// The finest maps that are tried, or few directions where these take too long.
LightField FinestMaps(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor)
{
  PropagationSettings finest;
  finest.directionsPerFace = *std::max_element(settings.directionsPerFace.begin(), settings.directionsPerFace.end());
  finest.mapResolution = *std::max_element(settings.mapResolutions.begin(), settings.mapResolutions.end());
  finest.tolerance = settings.tolerance;
  try
  {
    return Propagate(device, scene, finest, PartWithin(seconds, monitor, 0.5, 0.9));
  }
  catch (const TimeIsUp&)
  {
    finest.directionsPerFace = PropagationSettings().directionsPerFace;
    finest.mapResolution = 1;
    return Propagate(device, scene, finest, PartWithin(HUGE_VAL, monitor, 0.9, 1.0));
  }
}

/// A few photons, to forecast by.
struct Pilot
{
  Means means;
  int channels = 1;
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
  while (
    pilot.means.Count < FewestToForecast || (pilot.means.Count < MostToForecast && ClockSeconds() - begun < seconds))
  {
    const LightField light = march(pilot.means.Count + 1);
    pilot.means.Add(light.fluence);
    pilot.channels = light.channels;
  }
  pilot.seconds = (ClockSeconds() - begun) / (static_cast<double>(pilot.photons) * pilot.means.Count);
  return pilot;
}

/// What the maps are off by at least, squared: their distance from photons, less what the photons' chance makes of it
/// and twice the standard deviation of that.
double SquaredErrorOfMaps(const Pilot& pilot, const LightField& maps)
{
  const std::vector<float> values = pilot.means.Values();
  const double variance = pilot.means.Variance(), sets = pilot.means.Count;
  const double deviation = std::sqrt((2.0 + 2.0 / (sets - 1.0)) / static_cast<double>(values.size()));
  const double distance = SquaredDistance(values, pilot.channels, maps.fluence, maps.channels);
  return std::max(distance - (1.0 + 2.0 * deviation) * variance, 0.0);
}
}

ReferenceLight ReferenceOfPhotons(Device& device, const ComparedScene& scene, const ComparedSettings& settings,
  std::size_t set, double seconds, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const bool all = settings.scattersReference;
  Means means, direct;
  ReferenceLight reference;
  while (means.Count < MostSets && (means.Count < FewestSets || ClockSeconds() - start < seconds))
  {
    const Monitor part = PartWithin(HUGE_VAL, monitor, 1.0 * means.Count / MostSets, (means.Count + 1.0) / MostSets);
    LightField light = MarchEvenly(device, scene, set, all ? 0 : 1, static_cast<std::uint64_t>(means.Count) + 1, part);
    means.Add(light.fluence);
    direct.Add(all ? light.fluenceDirect : light.fluence);
    reference.channels = light.channels;
  }
  reference.grid = scene.medium.grid;
  reference.fluence = all ? means.Values() : std::vector<float>();
  reference.fluenceDirect = direct.Values();
  char text[160];
  std::snprintf(text, sizeof(text), "%d times %zu photons%s, not filtered, standard error %.2g, %.3g s", means.Count,
    set, all ? " that are scattered until they end" : "", means.RelativeError(), ClockSeconds() - start);
  reference.text = text;
  return reference;
}

PhotonForecast ForecastOfPhotons(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const auto largest =
    static_cast<std::size_t>(*std::max_element(settings.photonCounts.begin(), settings.photonCounts.end()));
  PhotonForecast forecast;
  Pilot pilot;
  try
  {
    pilot = FewPhotons(device, scene, largest, PartOfTime * seconds, PartWithin(HUGE_VAL, monitor, 0.0, 0.5));
  }
  catch (const TimeIsUp&)
  {
    forecast.why = "not photons: they are scattered too often for the time";
    return forecast;
  }
  const LightField maps = FinestMaps(device, scene, settings, PartOfTime * seconds, monitor);
  const double left = seconds - (ClockSeconds() - start), all = pilot.means.SumOfSquares();
  const double made = static_cast<double>(pilot.photons) * pilot.means.Count;
  const double ofMaps = std::sqrt(SquaredErrorOfMaps(pilot, maps) / all);
  const double ofMade = std::sqrt(pilot.means.Variance() / all);
  const double affordable = std::min(std::max(left / pilot.seconds, 1.0), 1.0 * FewestSets * MostOfASet);
  const double ofAffordable = ofMade * std::sqrt(made / affordable);
  forecast.beats = all > 0.0 && ofAffordable <= Beats * ofMaps;
  const double wanted = made * std::pow(ofMade / (Enough * ofMaps), 2);
  const double photons = forecast.beats ? std::min(affordable, std::max(wanted, 1.0 * LeastToForecast)) : affordable;
  forecast.photonsOfASet = static_cast<std::size_t>(std::ceil(photons / FewestSets));
  forecast.why = (forecast.beats ? "photons: their standard error was forecast to be "
                                 : "not photons: their standard error would be about ") +
    Text("%.2g", ofMade * std::sqrt(made / photons)) + ", the finest maps compared are off by at least " +
    Text("%.2g", ofMaps);
  return forecast;
}
}
