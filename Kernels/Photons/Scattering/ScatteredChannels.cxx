#include "Photons/Scattering/ScatteredChannels.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
/// One channel of a medium, with its own arrays.
struct OneChannelMedium
{
  OneChannelMedium(const Medium& medium, int channel)
    : seen(medium)
  {
    const auto take = [&](Field& field, std::vector<float>& values) {
      for (std::size_t i = 0; i < medium.grid.VoxelCount() && field.values; ++i)
      {
        values.push_back(field.At(i, channel));
      }
      field = { values.empty() ? nullptr : values.data(), 1 };
    };
    take(this->seen.sigma_a, this->sigma_a);
    take(this->seen.sigma_s, this->sigma_s);
    this->seen.emission = {};
    this->seen.phase = medium.phase.Seen(channel);
  }
  OneChannelMedium(const OneChannelMedium&) = delete;
  OneChannelMedium& operator=(const OneChannelMedium&) = delete;

  std::vector<float> sigma_a, sigma_s;
  Medium seen;
};

/// Adds the light of one run, times a colour, to all channels or to the only one.
void AddRun(const ScatteredPhotons& found, const Rgb& colour, PhotonLight& light)
{
  const auto channels = static_cast<std::size_t>(light.light.channels);
  EnergyBalance& balance = light.light.balance;
  for (std::size_t c = 0; c < channels; ++c)
  {
    balance.entered[c] += colour[c] * found.entered;
    balance.absorbed[c] += colour[c] * found.absorbed;
    balance.leftOver[c] += colour[c] * (found.leftOver - found.exchanged);
    light.exchanged[c] += colour[c] * found.exchanged;
    for (std::size_t face = 0; face < 6; ++face)
    {
      light.light.facePowerOut[face][c] += colour[c] * found.escaped[face];
      balance.escaped[c] += colour[c] * found.escaped[face];
    }
    for (std::size_t i = 0; i < found.fluence.size(); ++i)
    {
      light.light.fluence[i * channels + c] += static_cast<float>(colour[c] * found.fluence[i]);
    }
  }
  light.scatterings += found.scatterings;
}
}

ScatteredChannels::ScatteredChannels(Device& device, const Block& block)
  : Settings(block.settings)
{
  for (int c = 0; c < (block.coloured ? 3 : 1); ++c)
  {
    Channel channel;
    if (const MarchMedium* const through = block.through)
    {
      const OneChannelMedium one(block.medium, c);
      if (block.coloured)
      {
        MarchTraits traits = through->traits;
        traits.coloured = false;
        traits.grey = traits.greyExtinction = true;
        auto own = std::make_unique<MarchMedium>(
          device, one.seen, block.ior, block.settings, traits, through->block, nullptr, block.levels);
        if (block.nodes)
        {
          own->SetNodes(*block.nodes);
        }
        channel.own = std::move(own);
      }
      channel.photons =
        std::make_unique<PhotonScattering>(block.coloured ? *channel.own : *through, one.seen, block.stepPart);
    }
    this->Channels.push_back(std::move(channel));
  }
}

/// Contribution of one unit of a run's light to each channel.
Rgb ScatteredChannels::ColourOfRun(const PackedPhotons& packed, bool oneRun, int run)
{
  Rgb colour = {};
  colour[static_cast<std::size_t>(run)] = 1.0;
  return oneRun ? packed.colour : colour;
}

void ScatteredChannels::AddTo(
  PhotonLight& light, const PackedPhotons& packed, const Monitor& monitor, const Follower& follow) const
{
  const MarchSettings& march = this->Settings;
  PhotonScattering::Settings settings;
  settings.seed = march.seed;
  settings.mostScatterings = march.maximumOrders == 0 ? settings.mostScatterings : march.maximumOrders - 1;
  light.light.fluenceDirect = light.light.fluence;
  light.light.balance = {};
  light.light.facePowerOut = {};
  const bool oneRun = this->Channels.size() == 1 && packed.channels == 1;
  const int runs = oneRun ? 1 : 3;
  std::vector<float> flow(light.meanDirection.size(), 0.0f);
  for (int run = 0; run < runs; ++run)
  {
    const double all = runs;
    const std::size_t of = this->Channels.size() == 1 ? 0 : static_cast<std::size_t>(run);
    const double power = oneRun || packed.channels == 3 ? 1.0 : packed.colour[static_cast<std::size_t>(run)];
    const ScatteredPhotons found = follow(this->Channels[of].photons.get(),
      OneChannel(packed, packed.channels == 3 ? run : 0, power, PhotonScattering::DepositsPerEvent), settings,
      OfPart(monitor, run / all, (run + 1) / all));
    const Rgb colour = ColourOfRun(packed, oneRun, run);
    AddRun(found, colour, light);
    for (std::size_t i = 0; i < flow.size(); ++i)
    {
      flow[i] += static_cast<float>(Sum(colour) * found.flow[i]);
    }
  }
  const auto channels = static_cast<std::size_t>(light.light.channels);
  for (std::size_t i = 0; i < flow.size(); ++i)
  {
    double all = 0.0, direct = 0.0;
    for (std::size_t c = 0; c < channels; ++c)
    {
      const double counts = channels == 1 ? 3.0 : 1.0; // one channel stands for three
      all += counts * light.light.fluence[i / 3 * channels + c];
      direct += counts * light.light.fluenceDirect[i / 3 * channels + c];
    }
    light.meanDirection[i] = all > 0.0 ? static_cast<float>((direct * light.meanDirection[i] + flow[i]) / all) : 0.0f;
  }
}
}
