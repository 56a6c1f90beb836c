#include "Photons/Marching/MarchedLight.h"

#include "Device/Clock.h"
#include "Device/Device.h"
#include "Device/HostMappedBuffer.h"
#include "Device/HostMemory.h"
#include "Device/Sizes.h"
#include "Light/ChannelReduction.h"
#include "Light/LeftOut.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <random>
#include <utility>

namespace tyndall
{
namespace
{
/// Multiplies powers that were counted in a single channel by the colour that this channel stands for.
void Colour(const Rgb& colour, PhotonLight& result)
{
  EnergyBalance& balance = result.light.balance;
  const auto spread = [&](Rgb& watts) { watts = { watts[0] * colour[0], watts[0] * colour[1], watts[0] * colour[2] }; };
  for (Rgb* watts : { &balance.entered, &balance.absorbed, &balance.escaped, &balance.leftOver, &result.scattered })
  {
    spread(*watts);
  }
  std::for_each(result.light.facePowerOut.begin(), result.light.facePowerOut.end(), spread);
}

/// Replaces this rank's powers and numbers by their sums over all ranks. Collective.
void SumUp(const Domain& domain, const std::vector<Rgb*>& powers, const std::vector<double*>& numbers)
{
  std::vector<double> values;
  for (const Rgb* power : powers)
  {
    values.insert(values.end(), power->begin(), power->end());
  }
  std::transform(
    numbers.begin(), numbers.end(), std::back_inserter(values), [](const double* number) { return *number; });
  values = domain.Sum(values);
  auto value = values.cbegin();
  for (Rgb* power : powers)
  {
    std::copy_n(value, 3, power->begin());
    value += 3;
  }
  for (double* number : numbers)
  {
    *number = *value++;
  }
}

}

MarchedLight::MarchedLight(const MarchMedium& medium)
  : Medium(medium)
{
}

MarchShares MarchedLight::Share(int numbers, int batches) const
{
  return ShareSums(this->Medium, this->Medium.Records(), numbers, batches, this->Sums.Size() * sizeof(cl_long));
}

MarchSums MarchedLight::Prepare(const PackedPhotons& packed)
{
  const MarchSettings& settings = this->Medium.settings;
  MarchSums target;
  target.records = this->Medium.Records();
  target.directions = settings.meanDirection;
  target.counts = settings.counts;
  target.numbers = packed.channels + (settings.meanDirection ? 3 : 0) + (settings.counts ? 1 : 0);
  target.shares = this->Share(target.numbers, packed.Batches());
  const std::size_t needed =
    target.records * static_cast<std::size_t>(target.numbers) * static_cast<std::size_t>(target.shares.copies);
  if (this->Sums.Size() != needed)
  {
    this->Sums = Buffer<cl_long>();
    this->Sums = Buffer<cl_long>(this->Medium.device, needed, "sums of the photons' light");
    this->Sums.Fill(0);
  }
  target.sums = &this->Sums;
  return target;
}

cl::Kernel MarchedLight::SumsKernel(
  const char* name, const PackedPhotons& packed, const MarchSums& target, const LightField& light) const
{
  return this->Medium.SumsKernel(name, packed.channels,
    Define("DIRECTIONS", target.directions) + Define("COUNTS", target.counts) + Define("COLOURS", light.channels) +
      Define("CARRIES", 0));
}

cl::Kernel MarchedLight::Show(
  const PackedPhotons& packed, const MarchSums& target, const LightField& light, const Buffer<float>& fluence) const
{
  cl::Kernel show = this->SumsKernel("show_light", packed, target, light);
  return With(show, this->Medium.DescribeSums(packed, target.shares), this->Medium.sigmaA, this->Medium.sigmaS,
    this->Sums, cl_ulong(target.records * static_cast<std::size_t>(target.numbers)), fluence);
}

void MarchedLight::FinishVoxels(const PackedPhotons& packed, const MarchSums& target, float weightUnit,
  PhotonLight& result, const Buffer<cl_long>& taken) const
{
  LightField& light = result.light;
  Device& device = this->Medium.device;
  const Grid& grid = this->Medium.grid;
  const std::size_t voxels = grid.VoxelCount(), rows = voxels / static_cast<std::size_t>(grid.size[0]);
  const std::size_t batches = static_cast<std::size_t>(target.shares.batches);
  const std::size_t colours = static_cast<std::size_t>(light.channels);
  MakeZeros({ { &light.fluence, voxels * colours }, { &result.meanDirection, target.directions ? 3 * voxels : 0 },
    { &result.photonCount, target.counts ? voxels : 0 }, { &result.photonWeight, target.counts ? voxels : 0 },
    { &result.batchFluence, batches > 1 ? batches * voxels * colours : 0 } });
  const auto lend = [&](std::vector<float>& values, const char* what) {
    return HostMappedBuffer<float>(device, values.data(), values.size(), what);
  };
  const HostMappedBuffer<float> fluence = lend(light.fluence, "fluence");
  const HostMappedBuffer<float> direction = lend(result.meanDirection, "mean direction");
  const HostMappedBuffer<float> count = lend(result.photonCount, "photon count");
  const HostMappedBuffer<float> weight = lend(result.photonWeight, "photon weight");
  const HostMappedBuffer<float> batchFluence = lend(result.batchFluence, "fluence by batches");

  const LightSumsInfo info = this->Medium.DescribeSums(packed, target.shares, weightUnit);
  cl::Kernel finish = this->SumsKernel("finish_light", packed, target, light);
  With(finish, info, this->Medium.sigmaA, this->Medium.sigmaS, this->Sums,
    cl_ulong(target.records * static_cast<std::size_t>(target.numbers)), fluence.Handle(), direction.Handle(),
    count.Handle(), weight.Handle(), batchFluence.Handle(), taken);
  this->Medium.Launch(finish, cl::NDRange(rows));
  for (const HostMappedBuffer<float>* array : { &fluence, &direction, &count, &weight, &batchFluence })
  {
    array->Fetch();
  }
}

void MarchedLight::FinishBricks(
  const PackedPhotons& packed, const MarchSums& target, PhotonLight& result, const Buffer<cl_long>& taken) const
{
  LightField& light = result.light;
  const MarchMedium& through = this->Medium;
  Device& device = through.device;
  const Grid& grid = through.grid;
  const std::size_t colours = static_cast<std::size_t>(light.channels), voxels = grid.VoxelCount();
  MakeZeros({ { &light.fluence, voxels * colours }, { &result.meanDirection, target.directions ? 3 * voxels : 0 } });
  const HostMappedBuffer<float> fluence(device, light.fluence.data(), light.fluence.size(), "fluence");
  const HostMappedBuffer<float> direction(
    device, result.meanDirection.data(), result.meanDirection.size(), "mean direction");
  cl::Kernel finish = this->SumsKernel("finish_bricks", packed, target, light);
  With(finish, through.DescribeSums(packed, target.shares), through.bricks.First(), through.sigmaA, through.sigmaS,
    this->Sums, cl_ulong(target.records * static_cast<std::size_t>(target.numbers)), fluence.Handle(),
    direction.Handle(), taken);
  through.Launch(finish, cl::NDRange(through.bricks.Count()));
  cl::Kernel fill = this->SumsKernel("fill_empty", packed, target, light);
  With(fill, through.DescribeSums(packed, target.shares), through.bricks.First(), fluence.Handle(), direction.Handle());
  through.Launch(fill, cl::NDRange(voxels / Count(grid.size[0])));
  fluence.Fetch();
  direction.Fetch();
}

void MarchedLight::Finish(
  const PackedPhotons& packed, const MarchSums& target, float weightUnit, PhotonLight& result) const
{
  LightField& light = result.light;
  const bool byBricks = this->Medium.bricks.AreThere();
  const std::size_t channels = static_cast<std::size_t>(packed.channels);
  const std::size_t rows = this->Medium.grid.VoxelCount() / Count(this->Medium.grid.size[0]);
  const Buffer<cl_long> taken(
    this->Medium.device, (byBricks ? this->Medium.bricks.Count() : rows) * 2 * channels, "tallies");
  if (byBricks)
  {
    this->FinishBricks(packed, target, result, taken);
  }
  else
  {
    this->FinishVoxels(packed, target, weightUnit, result, taken);
  }
  result.secondsMarching += ClockSeconds();

  const std::vector<cl_long> units = taken.Read();
  for (std::size_t i = 0; i < units.size(); ++i)
  {
    const double watts = units[i] * packed.unit;
    light.balance.absorbed[i % channels] += watts;
    result.scattered[i % channels] += i / channels % 2 == 1 ? watts : 0.0;
  }
}

void Tally(const PackedPhotons& packed, const std::vector<cl_int>& ends, PhotonLight& result)
{
  EnergyBalance& balance = result.light.balance;
  const std::size_t words = EndWords + static_cast<std::size_t>(packed.channels);
  std::array<std::array<std::int64_t, 3>, StillGoing + 1> out = {};
  for (std::size_t i = 0; i < ends.size() / words; ++i)
  {
    PhotonEnd end;
    std::memcpy(&end, ends.data() + i * words, sizeof(end));
    if (end.face == Elsewhere)
    {
      continue;
    }
    result.deposits += static_cast<std::size_t>(end.crossings);
    result.steps += static_cast<std::size_t>(end.steps);
    for (int c = 0; c < packed.channels; ++c)
    {
      cl_float units;
      std::memcpy(&units, ends.data() + i * words + EndWords + c, sizeof(units));
      // The small remaining power of dark photons is added to that of photons that were terminated.
      out[std::min<int>(end.face, StillGoing)][c] += WholeUnits(units);
    }
  }
  for (int c = 0; c < 3; ++c)
  {
    for (int face = 0; face < StillGoing; ++face)
    {
      const double watts = static_cast<double>(out[face][c]) * packed.unit;
      result.light.facePowerOut[face][c] += watts;
      balance.escaped[c] += watts;
    }
    balance.leftOver[c] += static_cast<double>(out[StillGoing][c]) * packed.unit;
  }
}

void AddUpTallies(const Domain& domain, PhotonLight& result)
{
  EnergyBalance& balance = result.light.balance;
  std::vector<Rgb*> powers = { &balance.absorbed, &balance.escaped, &balance.leftOver, &result.scattered };
  for (Rgb& face : result.light.facePowerOut)
  {
    powers.push_back(&face);
  }
  double deposits = static_cast<double>(result.deposits), steps = static_cast<double>(result.steps);
  SumUp(domain, powers, { &deposits, &steps });
  result.deposits = static_cast<std::size_t>(deposits);
  result.steps = static_cast<std::size_t>(steps);
}

void AddUpScattered(const Domain& domain, PhotonLight& result)
{
  EnergyBalance& balance = result.light.balance;
  std::vector<Rgb*> powers = { &balance.entered, &balance.absorbed, &balance.escaped, &balance.leftOver,
    &result.exchanged };
  for (Rgb& face : result.light.facePowerOut)
  {
    powers.push_back(&face);
  }
  double scatterings = static_cast<double>(result.scatterings);
  SumUp(domain, powers, { &scatterings });
  result.scatterings = static_cast<std::uint64_t>(scatterings);
}

void PutIntoColours(const PackedPhotons& packed, int colours, PhotonLight& result)
{
  if (packed.channels == 1 && result.light.channels == 3)
  {
    Colour(packed.colour, result);
  }
  if (colours < result.light.channels)
  {
    KeepOneChannel(result.light);
    KeepOneChannel(result.batchFluence);
    result.scattered = { result.scattered[0], 0.0, 0.0 };
  }
}

std::vector<std::string> LeftOutOf(
  const MarchTraits& traits, const MarchSettings& settings, const PackedPhotons& packed)
{
  std::vector<std::string> texts;
  const auto say = [&](bool condition, const char* text) {
    if (condition)
    {
      texts.emplace_back(text);
    }
  };
  say(settings.leaveOut && !traits.index.Varies(), left_out::ConstantIndex);
  say(packed.channels == 1, packed.grey ? left_out::Grey : left_out::OneColour);
  say(packed.channels == 3 && traits.Channels(settings) == 1, left_out::GreyExtinction);
  say(settings.leaveOut && !traits.scatters, left_out::NoScattering);
  say(settings.leaveOut && !traits.absorbs, left_out::NoAbsorption);
  return texts;
}

void SayWhatIsLeftOut(const MarchMedium& through, const PackedPhotons& packed, LightField& light)
{
  const auto say = [&](bool condition, const char* text) {
    if (condition)
    {
      light.leftOut.push_back(text);
    }
  };
  say(through.settings.maximumOrders == 1,
    "scattered light: fluence is what comes from the lights without being scattered");
  say(through.traits.emits, "emission: photons carry the light of lights only");
  say(through.bends && !through.hasLevels, "octree: none was given, paths go by steps of the same length");
  AddMissing(light.leftOut, LeftOutOf(through.traits, through.settings, packed));
  say(through.bricks.AreThere(), "light voxel by voxel in empty space: it is kept by bricks of 8x8x8 voxels there");
  say(!through.settings.meanDirection, "mean direction: it was not asked for");
}

namespace
{
constexpr Rgb White = { 1.0, 1.0, 1.0 };

void Add(Rgb& sum, const Rgb& more)
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    sum[c] += more[c];
  }
}

void AddBalance(PhotonLight& sum, const PhotonLight& part)
{
  EnergyBalance& all = sum.light.balance;
  const EnergyBalance& more = part.light.balance;
  Add(all.entered, more.entered);
  Add(all.emitted, more.emitted);
  Add(all.absorbed, more.absorbed);
  Add(all.escaped, more.escaped);
  Add(all.leftOver, more.leftOver);
  Add(sum.scattered, part.scattered);
  Add(sum.exchanged, part.exchanged);
  for (std::size_t face = 0; face < 6; ++face)
  {
    Add(sum.light.facePowerOut[face], part.light.facePowerOut[face]);
  }
  sum.scatterings += part.scatterings;
  sum.missed += part.missed;
  sum.deposits += part.deposits;
  sum.steps += part.steps;
  sum.secondsMarching += part.secondsMarching;
  sum.seconds += part.seconds;
}

void AddTo(std::vector<double>& sum, const std::vector<float>& part)
{
  sum.resize(part.size(), 0.0);
  std::transform(sum.begin(), sum.end(), part.begin(), sum.begin(), [](double a, float b) { return a + b; });
}

std::vector<float> Floats(const std::vector<double>& values)
{
  return { values.begin(), values.end() };
}

/// Repeats each value three times, once per channel.
void Widen(std::vector<double>& values)
{
  std::vector<double> three;
  for (double value : values)
  {
    three.insert(three.end(), 3, value);
  }
  values.swap(three);
}
}

// One photon of each group of `batches` consecutive photons is chosen at random. A fixed stride would not do:
// low-discrepancy samples depend on the digits of their indices. For example, all multiples of sixteen have the same
// last four binary digits. These are the leading digits of Hammersley's points, so that all photons of a batch would
// start in one part of the light.
PhotonNumbers NumbersOfBatch(std::size_t photons, std::size_t batch, std::size_t batches)
{
  std::mt19937 random; // with its default seed, so that every batch draws the same numbers
  PhotonNumbers numbers;
  for (std::size_t row = 0; row < photons; row += batches)
  {
    const std::size_t number = row + (batch + random()) % batches;
    if (number < photons)
    {
      numbers.push_back(number);
    }
  }
  return numbers;
}

void MarchedBatches::Add(PhotonLight&& part)
{
  ++this->Count;
  // This batch may have fewer channels than the earlier ones, if all of its photons happen to have one colour.
  if (this->Count > 1 && part.light.channels < this->All.light.channels)
  {
    Spread(part.light, White);
    part.scattered = part.exchanged = {};
  }
  if (this->Count > 1 && part.light.channels > this->All.light.channels)
  {
    Spread(this->All.light, White);
    for (std::vector<double>* values : { &this->Fluence, &this->Squares, &this->Direct })
    {
      Widen(*values);
    }
  }
  this->AddArrays(part);
  if (this->Count == 1)
  {
    this->All = std::move(part);
    return;
  }
  AddBalance(this->All, part);
}

void MarchedBatches::AddArrays(const PhotonLight& part)
{
  const auto channels = static_cast<std::size_t>(part.light.channels);
  AddTo(this->Fluence, part.light.fluence);
  AddTo(this->Direct, part.light.fluenceDirect);
  this->Squares.resize(part.light.fluence.size(), 0.0);
  for (std::size_t i = 0; i < part.light.fluence.size(); ++i)
  {
    this->Squares[i] += static_cast<double>(part.light.fluence[i]) * part.light.fluence[i];
  }
  this->Flow.resize(part.meanDirection.size(), 0.0);
  this->Weights.resize(part.meanDirection.size() / 3, 0.0);
  for (std::size_t i = 0; i < this->Weights.size(); ++i)
  {
    double weight = 0.0;
    for (std::size_t c = 0; c < channels; ++c)
    {
      weight += part.light.fluence[i * channels + c] / static_cast<double>(channels);
    }
    this->Weights[i] += weight;
    for (std::size_t a = 0; a < 3; ++a)
    {
      this->Flow[3 * i + a] += weight * part.meanDirection[3 * i + a];
    }
  }
}

PhotonLight MarchedBatches::Sum() &&
{
  if (this->Count < 2)
  {
    return std::move(this->All);
  }
  LightField& light = this->All.light;
  light.fluence = Floats(this->Fluence);
  light.fluenceDirect = Floats(this->Direct);
  light.fluenceError.clear();
  const double count = this->Count;
  for (std::size_t i = 0; i < this->Fluence.size(); ++i)
  {
    // The light is the sum over `count` independent batches, each with a part of the power. Its variance follows from
    // the scatter of the batches.
    const double scatter = this->Squares[i] - this->Fluence[i] * this->Fluence[i] / count;
    light.fluenceError.push_back(static_cast<float>(std::sqrt(std::max(scatter, 0.0) * count / (count - 1.0))));
  }
  for (std::size_t i = 0; i < this->Flow.size(); ++i)
  {
    const double weight = this->Weights[i / 3];
    this->All.meanDirection[i] = weight > 0.0 ? static_cast<float>(this->Flow[i] / weight) : 0.0f;
  }
  return std::move(this->All);
}
}
