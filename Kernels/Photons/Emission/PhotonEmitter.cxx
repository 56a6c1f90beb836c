#include "Photons/Emission/PhotonEmitter.h"

#include "Device/Errors.h"
#include "Device/HostMemory.h"
#include "Light/LeftOut.h"
#include "Medium/Medium.h"
#include "Numerics/NumberText.h"
#include "Photons/Emission/PhotonSources.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace tyndall
{
namespace
{
/// Number of samples used to estimate the fraction of a light's photons that reaches the volume.
constexpr std::size_t TrySamples = 4096;
constexpr std::size_t ReportEvery = 100000;

/// Photon source of a light, with a sampler of the square image that the importance map holds for this light. There is
/// no sampler if the map has no image for it.
struct SpreadSource
{
  PhotonSource source;
  std::optional<ImportanceSampler> sampler;

  /// Moves a sample to where the density of samples puts it.
  /// @return ratio of its photon's power to the power in uniform sampling
  double Move(PhotonSample& sample) const
  {
    if (!this->sampler)
    {
      return 1.0;
    }
    const ImportanceSampler::Place place = this->sampler->At(sample[0], sample[1]);
    sample[0] = place.u;
    sample[1] = place.v;
    return 1.0 / place.density;
  }
};

std::vector<SpreadSource> SpreadSources(std::vector<PhotonSource> sources, const EmissionSettings& settings)
{
  std::vector<SpreadSource> spread;
  for (PhotonSource& source : sources)
  {
    spread.push_back({ std::move(source), {} });
    const int square = settings.map ? settings.map->SquareOf(spread.back().source.light) : -1;
    if (square >= 0)
    {
      const float* density = settings.map->density.data() + static_cast<std::size_t>(square) * settings.map->Cells();
      spread.back().sampler.emplace(density, settings.map->size, settings.densestAtMost);
    }
  }
  return spread;
}

/// Estimates of a light's properties from a few of its samples.
struct Tried
{
  double power = 0.0; ///< W, power that the light sends into the volume, sum of channels
  double hits = 0.0;  ///< fraction of the samples whose photons reach the volume
};

Tried Try(const Grid& grid, const SpreadSource& light)
{
  const SampleSequence samples(Sampler::Halton, TrySamples);
  if (light.source.alike)
  {
    const std::optional<Shot> shot = light.source.shoot(samples[0]);
    return shot && Sum(shot->power) > 0.0 ? Tried{ Sum(shot->power), 1.0 } : Tried{};
  }
  Tried tried;
  for (std::size_t i = 0; i < TrySamples; ++i)
  {
    PhotonSample sample = samples[i];
    const double weight = light.Move(sample);
    const std::optional<Shot> shot = light.source.shoot(sample);
    if (shot && Sum(shot->power) > 0.0 && Land(grid, *shot))
    {
      tried.power += weight * Sum(shot->power) / TrySamples;
      tried.hits += 1.0 / TrySamples;
    }
  }
  return tried;
}

/// Divides `count` photons among lights in proportion to power, at least one for each light that reaches the volume.
std::vector<std::size_t> Shares(const std::vector<Tried>& tried, std::size_t count)
{
  double left = 0.0;
  for (const Tried& light : tried)
  {
    left += light.power;
  }
  std::vector<std::size_t> shares;
  for (const Tried& light : tried)
  {
    const auto share =
      static_cast<std::size_t>(std::lround(left > 0.0 ? count * std::min(light.power / left, 1.0) : 0.0));
    shares.push_back(light.power > 0.0 ? std::max<std::size_t>(share, 1) : 0);
    count -= std::min(count, shares.back());
    left -= light.power;
  }
  return shares;
}

/// Photon of one sample, moved to the point where it enters the volume; empty if the sample emits none or misses the
/// volume.
/// @param weight  weight of the photon, Photon::weight
/// @param part    fraction of its light's power that the photon carries in uniform sampling
std::optional<Photon> PhotonOf(const Grid& grid, const std::optional<Shot>& shot, double weight, double part)
{
  std::optional<Photon> photon = shot && Sum(shot->power) > 0.0 ? Land(grid, *shot) : std::optional<Photon>();
  if (photon)
  {
    photon->weight = static_cast<float>(weight);
    for (int c = 0; c < 3; ++c)
    {
      photon->power[c] = static_cast<float>(shot->power[c] * weight * part);
    }
  }
  return photon;
}

/// Checks that the photons' powers are in the range of float: not 0, not infinite, and not so small that digits are
/// lost.
/// @param parts  number of parts of the emission; each call computes one part. If there are several, `mean` decides
///   whether power is too small, because photons of other parts may be brighter
/// @param mean   power of all lights over the number of photons of all parts, W
void CheckPowers(const EmittedPhotons& emitted, int parts, double mean)
{
  float largest = 0.0f;
  std::size_t brightest = 0;
  for (std::size_t i = 0; i < emitted.photons.size(); ++i)
  {
    const std::array<float, 3>& power = emitted.photons[i].power;
    const float most = std::max({ power[0], power[1], power[2] });
    if (most > largest)
    {
      largest = most;
      brightest = i;
    }
  }
  const bool tooLarge = std::isinf(largest);
  const double most = parts > 1 ? std::max<double>(mean, largest) : largest;
  if (emitted.photons.empty() || (!tooLarge && most >= std::numeric_limits<float>::min()))
  {
    return;
  }
  const int light = emitted.lights[brightest];
  const std::string name = light >= 0 ? "light " + std::to_string(light)
    : light == EnvironmentLight       ? "the environment or sky"
                                      : "the faces";
  throw InvalidInput("A photon of " + name + " would carry " +
    (tooLarge ? "more power than 3.4e+38 W" : "less power than 1.2e-38 W") +
    ", beyond what a float holds. Give lights " + (tooLarge ? "less power, ask for more photons" : "more power") +
    ", or choose another unit of length: power goes with the area of the volume.");
}

void Check(const EmissionSettings& settings)
{
  Require(settings.photonCount > 0, "The number of photons is 0; ask for at least one.");
  Require(settings.batches >= 1 && settings.batches <= EmittedBatchesAtMost,
    "The number of batches is " + std::to_string(settings.batches) + "; it must be 1 to " +
      std::to_string(EmittedBatchesAtMost) + ".");
  Require(settings.part >= 0 && settings.part < settings.parts,
    "There is no part " + std::to_string(settings.part) + " of " + std::to_string(settings.parts) + " of the photons.");
  Require(settings.densestAtMost >= 1.0,
    "The density of photons at most is " + Text("%g", settings.densestAtMost) +
      " times that of photons spread evenly; it must be at least 1.");
  if (settings.map)
  {
    Check(*settings.map);
  }
  constexpr std::size_t bytesEach = sizeof(Photon) + sizeof(int);
  const std::size_t made = settings.photonCount / static_cast<std::size_t>(settings.parts);
  RequireHostMemory(static_cast<double>(made) * bytesEach,
    std::to_string(made) + " photons of " + std::to_string(bytesEach) + " bytes each: that",
    "Ask for fewer photons (PhotonCount).");
}

/// Numbers of the samples of one light. The emission may be divided into parts (EmissionSettings::part); a call
/// computes one part and uses only a range of the samples.
struct Tries
{
  std::size_t all = 0;            ///< number of all samples of the light
  std::size_t begin = 0, end = 0; ///< range of them that this call uses
};

/// Returns, for each light, its number of samples and the range of samples in the part of the emission that this call
/// computes.
std::vector<Tries> TriesOf(const std::vector<Tried>& tried, const EmissionSettings& settings)
{
  const std::vector<std::size_t> shares = Shares(tried, settings.photonCount);
  std::vector<Tries> tries(tried.size());
  std::size_t all = 0;
  for (std::size_t s = 0; s < tried.size(); ++s)
  {
    if (shares[s] > 0)
    {
      // Each batch has at least one photon of each light, because each batch must estimate the light of all sources
      // without bias.
      tries[s].all = std::max(
        static_cast<std::size_t>(std::lround(shares[s] / tried[s].hits)), static_cast<std::size_t>(settings.batches));
    }
    all += tries[s].all;
  }
  const auto part = static_cast<std::size_t>(settings.part), parts = static_cast<std::size_t>(settings.parts);
  const std::size_t begin = all * part / parts, end = all * (part + 1) / parts;
  std::size_t before = 0;
  for (Tries& ofLight : tries)
  {
    ofLight.begin = std::clamp(begin, before, before + ofLight.all) - before;
    ofLight.end = std::clamp(end, before, before + ofLight.all) - before;
    before += ofLight.all;
  }
  return tries;
}

/// Texts that report which work the emission of all parts leaves out.
std::vector<std::string> LeftOutOf(const std::vector<Tried>& tried, const std::vector<Tries>& tries)
{
  std::vector<std::string> words;
  const auto sources = static_cast<int>(tried.size());
  const auto beside = static_cast<int>(
    std::count_if(tried.begin(), tried.end(), [](const Tried& light) { return !(light.power > 0.0); }));
  if (beside > 0)
  {
    words.push_back(left_out::SourcesBesideVolume(beside, sources));
  }
  double samples = 0.0, photons = 0.0;
  for (std::size_t s = 0; s < tries.size(); ++s)
  {
    samples += static_cast<double>(tries[s].all);
    photons += static_cast<double>(tries[s].all) * tried[s].hits;
  }
  if (photons < samples)
  {
    words.push_back(left_out::PhotonsBesideVolume(1.0 - photons / samples));
  }
  return words;
}

/// Divides weights and powers of a batch's photons, from index `first` on, by the mean weight of the batch's samples,
/// which is 1 up to statistical fluctuation: the powers of a directional light then sum to the power that reaches the
/// volume.
void Normalize(EmittedPhotons& emitted, std::size_t first, double mean)
{
  for (auto photon = emitted.photons.begin() + static_cast<std::ptrdiff_t>(first); photon < emitted.photons.end();
       ++photon)
  {
    photon->weight = static_cast<float>(photon->weight / mean);
    for (int c = 0; c < 3; ++c)
    {
      photon->power[c] = static_cast<float>(photon->power[c] / mean);
      emitted.power[c] += photon->power[c];
    }
  }
}

/// Emits the photons of one light, batch by batch.
void EmitFrom(const Grid& grid, const SpreadSource& light, const Tries& tries, std::uint64_t seed,
  const EmissionSettings& settings, const Monitor& monitor, EmittedPhotons& emitted)
{
  const auto batches = static_cast<std::size_t>(settings.batches);
  for (std::size_t b = 0; b < batches; ++b)
  {
    const std::size_t first = b * tries.all / batches, count = (b + 1) * tries.all / batches - first;
    const SampleSequence samples(settings.sampler, count, seed, settings.batches > 1 ? static_cast<int>(b) : 0);
    const std::size_t begin = std::max(tries.begin, first) - first;
    const std::size_t end = std::min(count, std::max(tries.end, first) - first);
    const std::size_t made = emitted.photons.size();
    double weights = light.sampler ? 0.0 : static_cast<double>(count);
    // The mean weight includes the samples of other parts. Without a density of samples all weights are 1.
    for (std::size_t i = light.sampler ? 0 : begin; i < (light.sampler ? count : end); ++i)
    {
      PhotonSample sample = samples[i];
      const double weight = light.Move(sample);
      weights += light.sampler ? weight : 0.0;
      if (i < begin || i >= end)
      {
        continue;
      }
      const std::optional<Photon> photon =
        PhotonOf(grid, light.source.shoot(sample), weight, 1.0 / (static_cast<double>(batches) * count));
      if (photon)
      {
        emitted.photons.push_back(*photon);
        emitted.photons.back().batch = static_cast<std::int32_t>(b);
        emitted.lights.push_back(light.source.light);
      }
      if ((first + i) % ReportEvery == ReportEvery - 1)
      {
        const double all = static_cast<double>(emitted.photons.size()) * settings.parts;
        Report(monitor, std::min(1.0, all / static_cast<double>(settings.photonCount)));
      }
    }
    Normalize(emitted, made, weights / static_cast<double>(count));
  }
}
}

EmittedPhotons EmitPhotons(
  const Grid& grid, const Illumination& illumination, const EmissionSettings& settings, const Monitor& monitor)
{
  tyndall::Check(grid);
  tyndall::Check(illumination);
  Check(settings);
  const std::vector<SpreadSource> lights = SpreadSources(PhotonSourcesOf(grid, illumination), settings);
  std::vector<Tried> tried;
  for (const SpreadSource& light : lights)
  {
    tried.push_back(Try(grid, light));
  }
  const std::vector<Tries> tries = TriesOf(tried, settings);
  EmittedPhotons emitted;
  emitted.leftOut = LeftOutOf(tried, tries);
  emitted.photons.reserve(settings.photonCount / static_cast<std::size_t>(settings.parts) + 1);
  for (std::size_t s = 0; s < lights.size(); ++s)
  {
    if (tries[s].begin < tries[s].end)
    {
      EmitFrom(grid, lights[s], tries[s], settings.seed == 0 ? 0 : settings.seed + s, settings, monitor, emitted);
    }
  }
  double power = 0.0;
  for (const Tried& light : tried)
  {
    power += light.power;
  }
  CheckPowers(emitted, settings.parts, power / static_cast<double>(settings.photonCount));
  return emitted;
}

std::vector<PilotPhotons> EmitPilots(const Grid& grid, const Illumination& illumination, int edge, std::uint64_t seed)
{
  tyndall::Check(illumination);
  const auto rows = static_cast<std::size_t>(edge);
  const SampleSequence samples(Sampler::Jittered, rows * rows, seed);
  std::vector<PilotPhotons> pilots;
  for (const PhotonSource& source : PhotonSourcesOf(grid, illumination))
  {
    if (source.light < EnvironmentLight)
    {
      continue;
    }
    pilots.emplace_back();
    pilots.back().light = source.light;
    for (std::size_t i = 0; i < rows * rows; ++i)
    {
      const std::optional<Photon> photon =
        PhotonOf(grid, source.shoot(samples[i]), 1.0, 1.0 / static_cast<double>(rows * rows));
      if (photon)
      {
        pilots.back().photons.push_back(*photon);
        pilots.back().origins.push_back({ static_cast<int>(i % rows), static_cast<int>(i / rows) });
      }
    }
  }
  return pilots;
}
}
