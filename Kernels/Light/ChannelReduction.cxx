#include "Light/ChannelReduction.h"

#include "Light/LeftOut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
/// Expands each group of `width` values to three groups: the group multiplied by the red, the green and the blue
/// component of `colour`.
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

/// Applies change(power) to each power of a LightField that is stored by channel, and multiplies its powers that are
/// summed over channels by `scale`.
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
  for (std::vector<float>* values :
    { &light.fluence, &light.fluenceDirect, &light.fluenceError, &light.scatteredRadiance, &light.surfaceRadiance,
      &light.surfaceError, &light.scatteredMoments, &light.facePower })
  {
    act(*values, std::size_t{ 1 });
  }
  act(light.netFlux, std::size_t{ 3 });
  act(light.firstMoments, std::size_t{ 6 });
}

/// A view of a field in which all channels use the component of `channel`. Unchanged if all channels already use one
/// component.
Field InChannel(const Field& field, int channel)
{
  return { field.values, field.components, field.HasColour() ? channel : field.standsForAll };
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

OneChannelScene::OneChannelScene(const Medium& given, const Illumination& illumination, int channel)
  : medium(given)
  , light(illumination)
{
  const auto grey = [&](Rgb& rgb) { rgb = { rgb[channel], rgb[channel], rgb[channel] }; };
  this->medium.sigma_a = InChannel(given.sigma_a, channel);
  this->medium.sigma_s = InChannel(given.sigma_s, channel);
  this->medium.emission = InChannel(given.emission, channel);
  this->medium.phase = given.phase.Seen(channel);
  this->light.uncollided.fluence = InChannel(illumination.uncollided.fluence, channel);
  std::for_each(this->light.uncollided.escaped.begin(), this->light.uncollided.escaped.end(), grey);
  grey(this->light.sky);
  std::for_each(this->light.faces.begin(), this->light.faces.end(), grey);
  std::for_each(this->light.faceAlbedo.begin(), this->light.faceAlbedo.end(), grey);
  for (Light& lamp : this->light.lights)
  {
    grey(lamp.power);
  }
  std::vector<float>& radiance = this->light.environment.radiance;
  for (std::size_t i = 0; i + 2 < radiance.size(); i += 3)
  {
    std::fill_n(radiance.begin() + i, 3, radiance[i + channel]);
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

namespace
{
constexpr std::size_t Three = 3;

/// If any channel has angular moments, extends the moments of all channels to the highest degree of any channel.
void AlignMoments(std::vector<LightField>& channels)
{
  const std::size_t voxels = std::max<std::size_t>(channels[0].fluence.size(), 1);
  std::size_t harmonics = 0;
  for (const LightField& light : channels)
  {
    harmonics = std::max(harmonics, light.scatteredMoments.size() / voxels);
  }
  for (LightField& light : channels)
  {
    const bool has = !light.scatteredMoments.empty();
    const std::vector<float>& from = has ? light.scatteredMoments : light.scatteredRadiance;
    const std::size_t own = from.size() / voxels;
    std::vector<float> moments(harmonics > 0 ? voxels * harmonics : 0, 0.0f);
    for (std::size_t i = 0; own > 0 && i < moments.size(); i += harmonics)
    {
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(i / harmonics * own), own,
        moments.begin() + static_cast<std::ptrdiff_t>(i));
    }
    light.scatteredMoments = std::move(moments);
    light.straightOn.resize(harmonics > 0 ? voxels : 0, 0.0f);
    light.lampsApart = has ? light.lampsApart : std::vector<Light>();
  }
}

/// Fills an array of channels that do not have it with `value`, if others have it.
void FillMissing(std::vector<LightField>& channels, std::vector<float> LightField::*array, float value)
{
  std::size_t size = 0;
  for (const LightField& channel : channels)
  {
    size = std::max(size, (channel.*array).size());
  }
  for (LightField& channel : channels)
  {
    (channel.*array).resize(size, value);
  }
}

/// Warnings of three channels. Those that not all channels have name the colours that have them.
std::vector<std::string> JoinDoubts(const std::vector<LightField>& channels)
{
  constexpr std::array<const char*, Three> colours = { "red", "green", "blue" };
  std::vector<std::string> doubts;
  for (const LightField& channel : channels)
  {
    AddMissing(doubts, channel.doubts);
  }
  for (std::string& doubt : doubts)
  {
    std::string those;
    std::size_t count = 0;
    for (std::size_t c = 0; c < Three; ++c)
    {
      const std::vector<std::string>& own = channels[c].doubts;
      const bool has = std::find(own.begin(), own.end(), doubt) != own.end();
      those += has ? (those.empty() ? "" : ", ") + std::string(colours[c]) : "";
      count += has ? 1 : 0;
    }
    doubt = count < Three ? "In " + those + ": " + doubt : doubt;
  }
  return doubts;
}

/// Settings of three channels, joined by name. A setting that differs has three values, for red, green and blue; "-" is
/// the value of a channel that does not have it.
std::vector<std::string> JoinSettings(const std::vector<LightField>& channels)
{
  const std::string equals = " = ";
  const auto valueIn = [&](const LightField& channel, const std::string& name) {
    const std::vector<std::string>& texts = channel.settingsUsed;
    const auto found = std::find_if(texts.begin(), texts.end(),
      [&](const std::string& text) { return text.compare(0, name.size() + equals.size(), name + equals) == 0; });
    return found == texts.end() ? std::string("-") : found->substr(name.size() + equals.size());
  };
  std::vector<std::string> names;
  for (const LightField& channel : channels)
  {
    std::vector<std::string> own = channel.settingsUsed;
    std::for_each(own.begin(), own.end(), [&](std::string& text) { text.resize(text.find(equals)); });
    AddMissing(names, own);
  }
  std::for_each(names.begin(), names.end(), [&](std::string& name) {
    const std::string red = valueIn(channels[0], name), green = valueIn(channels[1], name),
                      blue = valueIn(channels[2], name);
    name += equals + (red == green && green == blue ? red : red + ", " + green + ", " + blue);
  });
  return names;
}

/// Interleaves groups of `width` values of three channels. Returns no values if the channels differ in their number of
/// values.
std::vector<float> Interleave(const std::array<const std::vector<float>*, Three>& channels, std::size_t width)
{
  const std::size_t count = channels[0]->size();
  std::vector<float> all;
  for (std::size_t group = 0; group < count && channels[1]->size() == count && channels[2]->size() == count;
       group += width)
  {
    for (const std::vector<float>* channel : channels)
    {
      const auto begin = channel->begin() + static_cast<std::ptrdiff_t>(group);
      all.insert(all.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
    }
  }
  return all;
}

/// Adds the report of a channel that was solved later to the report of `light`.
void AddReport(LightField& light, const LightField& channel)
{
  AddMissing(light.leftOut, channel.leftOut);
  light.converged = light.converged && channel.converged;
  const bool larger = !(channel.relativeError <= light.relativeError); // or one of both is not known
  light.relativeError = larger && !std::isnan(light.relativeError) ? channel.relativeError : light.relativeError;
  std::vector<ConvergenceRow>&rows = light.convergence, more = channel.convergence;
  const bool longer = more.size() > rows.size();
  light.sweepsSaved = longer ? channel.sweepsSaved : light.sweepsSaved;
  if (longer)
  {
    rows.swap(more);
  }
  for (std::size_t i = 0; i < rows.size() && !more.empty(); ++i)
  {
    const ConvergenceRow& other = more[std::min(i, more.size() - 1)];
    rows[i].seconds += other.seconds;
    rows[i].residual = std::max(rows[i].residual, other.residual);
    rows[i].change = std::max(rows[i].change, other.change);
    rows[i].absorbed += other.absorbed;
    rows[i].escaped += other.escaped;
    rows[i].leftOver += other.leftOver;
  }
}
}

LightField JoinChannels(std::vector<LightField> channels)
{
  AlignMoments(channels);
  FillMissing(channels, &LightField::facePower, 0.0f); // of faces that do not reflect
  FillMissing(channels, &LightField::surfaceRadiance, std::numeric_limits<float>::quiet_NaN());
  FillMissing(channels, &LightField::surfaceError, std::numeric_limits<float>::quiet_NaN());
  std::vector<std::string> doubts = JoinDoubts(channels), settingsUsed = JoinSettings(channels);
  std::array<std::vector<std::pair<std::vector<float>*, std::size_t>>, Three> arrays;
  for (std::size_t c = 0; c < Three; ++c)
  {
    ForArrays(
      channels[c], [&](std::vector<float>& values, std::size_t width) { arrays[c].emplace_back(&values, width); });
    arrays[c].emplace_back(&channels[c].straightOn, 1);
  }
  for (std::size_t i = 0; i < arrays[0].size(); ++i)
  {
    *arrays[0][i].first =
      Interleave({ arrays[0][i].first, arrays[1][i].first, arrays[2][i].first }, arrays[0][i].second);
  }
  LightField light = std::move(channels[0]);
  light.channels = static_cast<int>(Three);
  light.doubts = std::move(doubts);
  light.settingsUsed = std::move(settingsUsed);
  std::vector<Light> lamps;
  for (std::size_t c = 0; c < Three; ++c)
  {
    const LightField& one = c == 0 ? light : channels[c];
    for (Light lamp : one.lampsApart)
    {
      const double power = lamp.power[0];
      lamp.power = {};
      lamp.power[c] = power;
      lamps.push_back(lamp);
    }
    light.errorLength = std::max(light.errorLength, one.errorLength);
    const auto put = [c](Rgb& all, const Rgb& channel) { all[c] = channel[0]; };
    put(light.balance.entered, one.balance.entered);
    put(light.balance.emitted, one.balance.emitted);
    put(light.balance.absorbed, one.balance.absorbed);
    put(light.balance.escaped, one.balance.escaped);
    put(light.balance.leftOver, one.balance.leftOver);
    put(light.halfRangeFlux, one.halfRangeFlux);
    for (std::size_t face = 0; face < light.facePowerOut.size(); ++face)
    {
      put(light.facePowerOut[face], one.facePowerOut[face]);
      put(light.faceAlbedo[face], one.faceAlbedo[face]);
    }
    if (c > 0)
    {
      AddReport(light, one);
    }
  }
  light.lampsApart = std::move(lamps);
  std::vector<std::string>& omitted = light.leftOut;
  omitted.erase(std::remove(omitted.begin(), omitted.end(), left_out::Grey), omitted.end()); // of each channel alone
  return light;
}

void KeepOneChannel(std::vector<float>& interleaved)
{
  KeepOne(interleaved, 1);
}

LightField SolveOneByOne(const Monitor& monitor, KeptLight* kept,
  const std::function<LightField(int channel, const Monitor& monitor, KeptLight* kept)>& solve)
{
  constexpr int count = static_cast<int>(Three);
  KeptLight all;
  all.channels = kept ? std::move(kept->channels) : std::vector<KeptLight>();
  all.channels.resize(Three);
  std::vector<LightField> found;
  for (int c = 0; c < count; ++c)
  {
    KeptLight& ofChannel = all.channels[c];
    found.push_back(
      solve(c, OfPart(monitor, static_cast<double>(c) / count, (c + 1.0) / count), kept ? &ofChannel : nullptr));
    all.firstScattered[c] = ofChannel.firstScattered[0];
  }
  if (kept)
  {
    *kept = std::move(all);
  }
  return JoinChannels(std::move(found));
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
