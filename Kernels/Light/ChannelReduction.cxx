#include "Light/ChannelReduction.h"

#include "Light/LeftOut.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Expands each group of `width` values to three groups: its multiples by red, green and blue of `colour`.
void Spread(std::vector<float>& values, std::size_t width, const Rgb& colour)
{
  std::vector<float> three(3 * values.size());
  for (std::size_t group = 0; group < values.size(); group += width)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      for (std::size_t i = 0; i < width; ++i)
      {
        three[3 * group + c * width + i] = static_cast<float>(values[group + i] * colour[c]);
      }
    }
  }
  values.swap(three);
}

void KeepOne(std::vector<float>& values, std::size_t width)
{
  for (std::size_t group = 0; 3 * group < values.size(); group += width)
  {
    std::copy_n(values.begin() + 3 * group, width, values.begin() + group);
  }
  values.resize(values.size() / 3);
  values.shrink_to_fit();
}

/// Applies change(power) to each power by channel of a LightField, and multiplies its powers summed over channels by
/// `scale`.
template <class Change>
void ChangePowers(LightField& light, const Change& change, double scale)
{
  EnergyBalance& balance = light.balance;
  for (Rgb* watts : { &balance.entered, &balance.emitted, &balance.absorbed, &balance.escaped, &balance.leftOver })
  {
    change(*watts);
  }
  std::for_each(light.facePowerOut.begin(), light.facePowerOut.end(), change);
  for (ConvergenceRow& row : light.convergence)
  {
    row.absorbed *= scale;
    row.escaped *= scale;
    row.leftOver *= scale;
  }
}

/// Calls act(values, width) for every array of a LightField; `width` is the number of consecutive values per channel.
template <class Act>
void ForArrays(LightField& light, const Act& act)
{
  for (std::vector<float>* values : { &light.fluence, &light.fluenceDirect, &light.fluenceError,
         &light.scatteredRadiance, &light.surfaceRadiance, &light.scatteredMoments, &light.facePower })
  {
    act(*values, std::size_t{ 1 });
  }
  act(light.netFlux, std::size_t{ 3 });
  act(light.firstMoments, std::size_t{ 6 });
}

Field InChannel(const Field& field, int channel)
{
  return { field.values, field.components, field.components == 3 ? channel : -1 };
}
}

SceneChannels::SceneChannels(const Medium& medium, const MediumTraits& traits, const Illumination& illumination)
  : colour(ColourOf(illumination))
{
  const Field& uncollided = illumination.uncollided.fluence;
  if (uncollided.HasColour() && uncollided.values)
  {
    this->colour.Add(uncollided.values, medium.grid.VoxelCount());
  }
  else if (uncollided.values)
  {
    this->colour.Add(Rgb{ 1.0, 1.0, 1.0 });
  }
  this->given = medium.Channels() == 3 || uncollided.HasColour() || !this->colour.IsGrey() ? 3 : 1;
  if (traits.emits && traits.emission.IsOne())
  {
    this->colour.Add(traits.emission.Relative());
  }
  this->one = traits.grey && (!traits.emits || traits.emission.IsOne()) && this->colour.IsOne();
}

const char* SceneChannels::LeftOut() const
{
  return this->colour.IsGrey() ? left_out::Grey : left_out::OneColour;
}

void SceneChannels::Undo(LightField& light, int solved) const
{
  if (solved == 3 && this->given == 1)
  {
    KeepOneChannel(light);
  }
  if (solved == 1)
  {
    light.leftOut.insert(light.leftOut.begin(), this->LeftOut());
    if (this->given == 3)
    {
      Spread(light, this->colour.Relative());
    }
  }
}

OneChannelScene::OneChannelScene(const Medium& given, const Illumination& illumination, const SceneChannels& channels)
  : medium(given)
  , light(illumination)
{
  const int brightest = channels.colour.Brightest();
  const auto grey = [&](Rgb& rgb) { rgb = { rgb[brightest], rgb[brightest], rgb[brightest] }; };
  this->medium.sigma_a = InChannel(given.sigma_a, brightest);
  this->medium.sigma_s = InChannel(given.sigma_s, brightest);
  this->medium.emission = InChannel(given.emission, brightest);
  this->medium.phase = given.phase.Seen(brightest);
  this->light.uncollided.fluence = InChannel(illumination.uncollided.fluence, brightest);
  std::for_each(this->light.uncollided.escaped.begin(), this->light.uncollided.escaped.end(), grey);
  grey(this->light.sky);
  std::for_each(this->light.faces.begin(), this->light.faces.end(), grey);
  for (Light& lamp : this->light.lights)
  {
    grey(lamp.power);
  }
  std::vector<float>& radiance = this->light.environment.radiance;
  for (std::size_t i = 0; i + 2 < radiance.size(); i += 3)
  {
    std::fill_n(radiance.begin() + i, 3, radiance[i + brightest]);
  }
}

void Spread(LightField& light, const Rgb& colour)
{
  light.channels = 3;
  ForArrays(light, [&](std::vector<float>& values, std::size_t width) { Spread(values, width, colour); });
  ChangePowers(
    light,
    [&](Rgb& watts) {
      watts = { watts[0] * colour[0], watts[0] * colour[1], watts[0] * colour[2] };
    },
    Sum(colour));
}

void KeepOneChannel(std::vector<float>& interleaved)
{
  KeepOne(interleaved, 1);
}

void KeepOneChannel(LightField& light)
{
  light.channels = 1;
  ForArrays(light, KeepOne);
  ChangePowers(
    light,
    [](Rgb& watts) {
      watts = { watts[0], 0.0, 0.0 };
    },
    1.0 / 3.0);
}
}
