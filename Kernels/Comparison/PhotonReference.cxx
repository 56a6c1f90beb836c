#include "Comparison/PhotonReference.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Converts an index in an array with `wanted` channels per voxel to the index of the same value in an array with `has`
/// channels per voxel; `has` is `wanted` or 1.
std::size_t PlaceOf(std::size_t index, int has, int wanted)
{
  return has == wanted ? index : index / static_cast<std::size_t>(wanted);
}

constexpr int FewestSets = 16, MostSets = 64;            ///< least and largest number of photon sets of the reference
constexpr int FewestToForecast = 4, MostToForecast = 64; ///< least and largest number of photon sets of the pilot run
/// Number of photons per set of the pilot run: the largest photon count of the comparison divided by PartToForecast,
/// but at least LeastToForecast.
constexpr std::size_t PartToForecast = 16, LeastToForecast = 1000;
/// Largest number of photons per set; these photons take a hundred megabytes.
constexpr std::size_t MostOfASet = std::size_t{ 1 } << 21;
/// Photons are the reference only if their error is at most this fraction of the error of the finest light propagation
/// maps.
constexpr double Beats = 1.0 / 3.0;
/// Target for the error of the reference's photons, as a fraction of the error of the finest light propagation maps.
constexpr double Enough = 0.1;

constexpr double TypicalSweeps = 20.0;

/// Light propagation maps for the forecast, which decides whether photons are the better reference. `coarse` has few
/// directions. `finest` are the finest maps that are compared, if time and device allow them.
struct ForecastMaps
{
  std::optional<LightField> coarse, finest;

  std::optional<LightField>& Best() { return this->finest ? this->finest : this->coarse; }
};

/// Run time of light propagation maps, seconds, predicted from NominalSeconds.
/// @param sweeps  number of sweeps
double SecondsOf(const PropagationSettings& settings, const ComparedScene& scene, double sweeps)
{
  const int channels =
    std::max({ scene.medium.sigma_a.components, scene.medium.sigma_s.components, scene.medium.emission.components });
  return NominalSeconds::OfRayVoxel * channels * sweeps * 6.0 * settings.directionsPerFace * settings.mapResolution *
    settings.mapResolution * static_cast<double>(scene.medium.grid.VoxelCount());
}

/// Computes the light propagation maps for the forecast. Maps are left out if they do not fit the device, or if all
/// would take more than `seconds` together (NominalSeconds).
ForecastMaps FindMaps(
  Device& device, const ComparedScene& scene, const ComparedSettings& settings, double seconds, const Monitor& monitor)
{
  PropagationSettings finest, coarse;
  finest.directionsPerFace = *std::max_element(settings.directionsPerFace.begin(), settings.directionsPerFace.end());
  finest.mapResolution = finest.directionsPerFace < FewestForFinerMaps
    ? 1
    : *std::max_element(settings.mapResolutions.begin(), settings.mapResolutions.end());
  coarse.directionsPerFace = std::min(coarse.directionsPerFace, finest.directionsPerFace);
  finest.tolerance = coarse.tolerance = settings.tolerance;
  ForecastMaps maps;
  double sweeps = TypicalSweeps;
  const auto find = [&](const PropagationSettings& of, std::optional<LightField>& light, double from, double to) {
    const double needed = SecondsOf(of, scene, sweeps);
    if (needed > seconds)
    {
      return;
    }
    try
    {
      light = Propagate(device, scene, of, OfPart(monitor, from, to));
      sweeps = static_cast<double>(light->convergence.size());
      seconds -= SecondsOf(of, scene, sweeps);
    }
    catch (const DeviceError&)
    {
    }
  };
  find(coarse, maps.coarse, 0.0, 0.3);
  if (maps.coarse && (finest.directionsPerFace > coarse.directionsPerFace || finest.mapResolution > 1))
  {
    find(finest, maps.finest, 0.3, 1.0);
  }
  return maps;
}

/// Run time per photon, seconds, predicted from NominalSeconds and the mean path length of a photon: the volume
/// integral of the fluence, divided by the entered power.
/// @param light  estimate of the light
double SecondsOfPhoton(const ComparedScene& scene, const LightField& light)
{
  const Grid& grid = scene.medium.grid;
  double way = 0.0, scatterings = 0.0;
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    const std::size_t voxel = i / static_cast<std::size_t>(light.channels), channel = i - voxel * light.channels;
    way += light.fluence[i] * grid.VoxelVolume();
    scatterings += light.fluence[i] * grid.VoxelVolume() * scene.medium.sigma_s.At(voxel, static_cast<int>(channel));
  }
  double power = 0.0;
  for (int channel = 0; channel < light.channels; ++channel)
  {
    power += light.balance.entered[static_cast<std::size_t>(channel)];
  }
  const double edge = std::min({ grid.spacing[0], grid.spacing[1], grid.spacing[2] });
  // Mean number of voxel walls crossed by a straight segment whose length is a voxel edge.
  constexpr double wallsOfEdge = 1.5;
  return NominalSeconds::OfPhoton +
    (power > 0.0
        ? (NominalSeconds::OfCrossing * wallsOfEdge * way / edge + NominalSeconds::OfScattering * scatterings) / power
        : 0.0);
}

/// A pilot run with a few photons, from which the cost of a reference by photons is forecast.
struct Pilot
{
  MeansOfSets means;
  std::size_t photons = 0; ///< photons per set
  double seconds = 0.0;    ///< predicted run time per photon (NominalSeconds)
};

/// Pilot run with a few photons, in at least four sets.
/// @param largest  largest photon count of the comparison
/// @param maps  estimate of the light; null: there is none
/// @return no value if four sets take longer than `seconds`, by NominalSeconds
std::optional<Pilot> FewPhotons(Device& device, const ComparedScene& scene, std::size_t largest, double seconds,
  const LightField* maps, const Monitor& monitor)
{
  constexpr double all = MostToForecast + 1.0;
  Pilot pilot;
  pilot.photons = std::max(largest / PartToForecast, LeastToForecast);
  pilot.seconds = SecondsOfPhoton(
    scene, maps ? *maps : MarchEvenly(device, scene, LeastToForecast, 0, 1, OfPart(monitor, 0.0, 1.0 / all)));
  const double affordable = seconds / (pilot.seconds * static_cast<double>(pilot.photons));
  if (affordable < FewestToForecast)
  {
    return std::nullopt;
  }
  const int sets = static_cast<int>(std::min<double>(affordable, MostToForecast));
  for (int set = 1; set <= sets; ++set)
  {
    const LightField light = MarchEvenly(device, scene, pilot.photons, 0, static_cast<std::uint64_t>(set) + 1,
      OfPart(monitor, set / all, (set + 1) / all));
    pilot.means.Add(light.fluence, light.channels);
  }
  return pilot;
}
}

/// Expands the sums of one channel to `channels` equal channels.
void MeansOfSets::Widen(int channels)
{
  const auto widened = [channels](const std::vector<double>& values) {
    std::vector<double> all(values.size() * static_cast<std::size_t>(channels));
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      all[i] = values[PlaceOf(i, 1, channels)];
    }
    return all;
  };
  this->Sums = widened(this->Sums);
  this->Squares = widened(this->Squares);
  this->OfVoxel = channels;
}

void MeansOfSets::Add(const std::vector<float>& values, int channels)
{
  if (channels > this->OfVoxel)
  {
    this->Widen(channels);
  }
  const std::size_t size = values.size() / static_cast<std::size_t>(channels) * static_cast<std::size_t>(this->OfVoxel);
  this->Sums.resize(size);
  this->Squares.resize(size);
  for (std::size_t i = 0; i < size; ++i)
  {
    const double value = values[PlaceOf(i, channels, this->OfVoxel)];
    this->Sums[i] += value;
    this->Squares[i] += value * value;
  }
  ++this->Sets;
}

std::vector<float> MeansOfSets::Values() const
{
  std::vector<float> means(this->Sums.size());
  std::transform(this->Sums.begin(), this->Sums.end(), means.begin(),
    [this](double sum) { return static_cast<float>(sum / this->Sets); });
  return means;
}

double MeansOfSets::Variance() const
{
  double variance = 0.0;
  for (std::size_t i = 0; i < this->Sums.size(); ++i)
  {
    const double mean = this->Sums[i] / this->Sets;
    variance += std::max(0.0, this->Squares[i] / this->Sets - mean * mean) / (this->Sets - 1);
  }
  return variance;
}

double MeansOfSets::SumOfSquares() const
{
  double squares = 0.0;
  for (double sum : this->Sums)
  {
    squares += sum / this->Sets * sum / this->Sets;
  }
  return squares;
}

double MeansOfSets::RelativeError() const
{
  const double squares = this->SumOfSquares();
  return squares > 0.0 ? std::sqrt(this->Variance() / squares) : 0.0;
}

double MeansOfSets::SquaredErrorOf(const std::vector<float>& other, int channels) const
{
  const int most = std::max(channels, this->OfVoxel);
  const std::size_t size = other.size() / static_cast<std::size_t>(channels) * static_cast<std::size_t>(most);
  double distance = 0.0;
  for (std::size_t i = 0; i < size; ++i)
  {
    const double difference =
      this->Sums[PlaceOf(i, this->OfVoxel, most)] / this->Sets - other[PlaceOf(i, channels, most)];
    distance += difference * difference * this->OfVoxel / most;
  }
  const double deviation = std::sqrt((2.0 + 2.0 / (this->Sets - 1.0)) / static_cast<double>(this->Sums.size()));
  return std::max(distance - (1.0 + 2.0 * deviation) * this->Variance(), 0.0);
}

ReferenceLight ReferenceOfPhotons(Device& device, const ComparedScene& scene, const ComparedSettings& settings,
  std::size_t set, double seconds, const LightField* maps, const Monitor& monitor)
{
  const double start = device.Now();
  const bool all = settings.scattersReference;
  MeansOfSets fluence, direct;
  int sets = FewestSets;
  for (int made = 0; made < sets; ++made)
  {
    const Monitor part = OfPart(monitor, 1.0 * made / MostSets, (made + 1.0) / MostSets);
    LightField light;
    try
    {
      light = MarchEvenly(device, scene, set, all ? 0 : 1, static_cast<std::uint64_t>(made) + 1, part);
    }
    catch (const TimeIsUp&)
    {
      if (made < FewestToForecast)
      {
        throw;
      }
      break;
    }
    fluence.Add(light.fluence, light.channels);
    direct.Add(all ? light.fluenceDirect : light.fluence, light.channels);
    if (made == 0)
    {
      const double affordable = seconds / (SecondsOfPhoton(scene, light) * static_cast<double>(set));
      sets = static_cast<int>(std::clamp<double>(affordable, FewestSets, MostSets));
    }
  }
  ReferenceLight reference;
  reference.grid = scene.medium.grid;
  reference.channels = fluence.Channels();
  reference.fluence = all ? fluence.Values() : std::vector<float>();
  reference.fluenceDirect = direct.Values();
  reference.text = std::to_string(fluence.Count()) + " times " + std::to_string(set) + " photons" +
    (all ? " that are scattered until they end" : "") + ", not filtered, standard error " +
    Text("%.2g", fluence.RelativeError()) + ", " + Text("%.3g", device.Now() - start) + " s" +
    (fluence.Count() < FewestSets ? " (no more: the machine was too busy)" : "");
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
  // Time in seconds for the light propagation maps; the pilot run of photons may take the same time.
  const double part = 0.5 * PhotonForecast::PartOfTime * seconds;
  PhotonForecast forecast;
  ForecastMaps maps = FindMaps(device, scene, settings, part, OfPart(monitor, 0.0, 0.5));
  const int largest = *std::max_element(settings.photonCounts.begin(), settings.photonCounts.end());
  const std::optional<Pilot> pilot = FewPhotons(device, scene, static_cast<std::size_t>(largest), part,
    maps.coarse ? &*maps.coarse : nullptr, OfPart(monitor, 0.5, 1.0));
  if (!pilot)
  {
    forecast.why = "not photons: they are scattered too often for the time";
    return forecast;
  }
  forecast.maps = std::move(maps.Best());
  const double left = seconds - 2.0 * part, all = pilot->means.SumOfSquares();
  const double made = static_cast<double>(pilot->photons) * pilot->means.Count();
  const double ofMade = pilot->means.RelativeError();
  const double ofMaps = !forecast.maps ? HUGE_VAL
    : all > 0.0 ? std::sqrt(pilot->means.SquaredErrorOf(forecast.maps->fluence, forecast.maps->channels) / all)
                : 0.0;
  const double affordable = std::min(std::max(left / pilot->seconds, 1.0), 1.0 * FewestSets * MostOfASet);
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
