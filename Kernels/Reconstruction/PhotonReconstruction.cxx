#include "Reconstruction/PhotonReconstruction.h"

#include "Device/Errors.h"
#include "Device/HostMemory.h"
#include "Device/HostThreads.h"
#include "Distribution/SharedMedium.h"
#include "Light/LeftOut.h"
#include "Medium/Medium.h"
#include "Numerics/NumberText.h"
#include "Numerics/PyramidLayout.h"
#include "Reconstruction/LightPyramidShared.h"
#include "Reconstruction/Reconstruction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tyndall
{
namespace
{
using Estimator = ReconstructionSettings::Estimator;

/// Number of pyramid levels above the grid that each rank computes from its box (block and halo). The ranks then
/// exchange the cells of the highest of these levels.
constexpr int LevelsOfBox = 2;

/// Width in voxels of the halo that a rank needs to compute the pyramid levels of its box.
/// Conservative estimator, per level: one cell of the next coarser level for interpolation, four for gains and errors,
/// two for details and the levels from which these are computed.
/// Other estimators: along each axis the two cells of a level between which a voxel lies, each computed from four cells
/// of the next finer level.
int MarginOf(Estimator estimator)
{
  return estimator == Estimator::Conservative ? 32 : 16;
}

/// Alignment of the ranks' boxes: the index of a box's first voxel along each axis is a multiple of this number. For
/// estimators other than the conservative one it is 8, the width of a vector.
int EdgeOf(Estimator estimator, int shared)
{
  return estimator == Estimator::Conservative ? 1 << shared : 8;
}

/// Number of pyramid levels above a grid, at most `levels` and at least 1.
int LevelsOf(const Grid& grid, int levels)
{
  // At least 1, also for a grid of a single voxel: level 1 is then the voxel itself.
  return std::max(std::min(levels, PyramidLayout(grid.size).Top()), 1);
}

int TopOf(const ReconstructionSettings& settings, int levels)
{
  return settings.estimator == Estimator::ConstantRadius ? std::min(settings.level, levels) : levels;
}

void Add(std::array<double, 3>& sum, const std::array<double, 3>& more)
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    sum[c] += more[c];
  }
}

/// Summary of the values of an array.
struct ArrayRange
{
  bool fit = true;                  ///< whether every value lies within the required range
  float largest = 0.0f;             ///< largest value of the array
  std::array<double, 3> total = {}; ///< sum of the values of each component; [0] only, for one component
};

/// Computes the summary of an array. Several sums are accumulated in parallel, because each addition to a single sum
/// would wait for the previous one. Each quantity has its own loop over a block of values in cache, so that compilers
/// vectorise it.
/// @param low, high  required range of the values
ArrayRange RangeOf(const float* values, std::size_t count, std::size_t components, float low, float high)
{
  // Number of sums that are accumulated in parallel: a multiple of each possible number of components.
  constexpr std::size_t Lanes = 12;
  constexpr std::size_t Block = 256 * Lanes;
  double sums[Lanes] = {};
  float largest[Lanes] = {};
  int unfit = 0;
  for (std::size_t first = 0; first < count; first += Block)
  {
    const float* const block = values + first;
    const std::size_t size = std::min(Block, count - first), whole = size / Lanes * Lanes;
    for (std::size_t i = 0; i < size; ++i)
    {
      unfit |= !(block[i] >= low) | !(block[i] <= high);
    }
    for (std::size_t i = 0; i < whole; i += Lanes)
    {
      for (std::size_t lane = 0; lane < Lanes; ++lane)
      {
        sums[lane] += block[i + lane];
      }
    }
    for (std::size_t i = 0; i < whole; i += Lanes)
    {
      for (std::size_t lane = 0; lane < Lanes; ++lane)
      {
        largest[lane] = block[i + lane] > largest[lane] ? block[i + lane] : largest[lane];
      }
    }
    for (std::size_t i = whole; i < size; ++i)
    {
      sums[i - whole] += block[i];
      largest[i - whole] = std::max(largest[i - whole], block[i]);
    }
  }
  ArrayRange range;
  range.fit = unfit == 0;
  for (std::size_t lane = 0; lane < Lanes; ++lane)
  {
    range.largest = std::max(range.largest, largest[lane]);
    range.total[lane % components] += sums[lane];
  }
  return range;
}

ArrayRange RangeInThreads(const float* values, std::size_t count, int components, float low, float high)
{
  constexpr std::size_t Part = 12 * 8192;
  const std::size_t parts = (count + Part - 1) / Part;
  std::vector<ArrayRange> ranges(parts);
  InThreads(parts, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part)
    {
      const std::size_t first = part * Part;
      ranges[part] =
        RangeOf(values + first, std::min(Part, count - first), static_cast<std::size_t>(components), low, high);
    }
  });
  ArrayRange all;
  for (const ArrayRange& range : ranges)
  {
    all.fit &= range.fit;
    all.largest = std::max(all.largest, range.largest);
    Add(all.total, range.total);
  }
  return all;
}

/// Checks the values of an array of the block, and returns their summary.
/// @param width  values per voxel: the components of one batch or of several
/// @throws InvalidInput if a value is out of range; names its voxel of the domain
ArrayRange CheckedRange(const Domain& domain, const float* values, int width, int components, const char* name,
  float low = 0.0f, float high = std::numeric_limits<float>::max())
{
  const std::size_t count = domain.Own().VoxelCount() * static_cast<std::size_t>(width);
  const ArrayRange range = RangeInThreads(values, count, components, low, high);
  if (!range.fit)
  {
    const float* const unfit =
      std::find_if_not(values, values + count, [&](float value) { return value >= low && value <= high; });
    const std::array<int, 3> voxel =
      domain.Own().VoxelAt(static_cast<std::size_t>(unfit - values) / static_cast<std::size_t>(width));
    throw InvalidInput(std::string(name) + " is " + Text("%g", *unfit) + " in voxel " +
      VoxelName(domain.Whole(), domain.Whole().IndexOf(voxel)) + " (the first such voxel); it must be finite and " +
      (low < 0.0f ? "no longer than 1." : "not negative.") + " Clean the light, or march the photons anew.");
  }
  return range;
}

/// Sum of the values of each channel over the voxels of the box `part`, from an array over the larger box `box`.
std::array<double, 3> TotalOf(const float* values, const VoxelBox& box, const VoxelBox& part, int channels)
{
  Grid grid;
  grid.size = box.size;
  const auto width = static_cast<std::size_t>(channels);
  std::vector<std::array<double, 3>> ofLayers(static_cast<std::size_t>(part.size[2]));
  InThreads(ofLayers.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z)
    {
      for (int y = 0; y < part.size[1]; ++y)
      {
        const std::size_t first = grid.IndexOf({ part.first[0] - box.first[0], part.first[1] - box.first[1] + y,
          part.first[2] - box.first[2] + static_cast<int>(z) });
        Add(ofLayers[z],
          RangeOf(values + first * width, static_cast<std::size_t>(part.size[0]) * width, width, 0.0f, 0.0f).total);
      }
    }
  });
  std::array<double, 3> total = {};
  for (const std::array<double, 3>& layer : ofLayers)
  {
    Add(total, layer);
  }
  return total;
}

std::size_t CountOf(std::size_t voxels, int components, bool needed)
{
  return needed ? voxels * static_cast<std::size_t>(components) : 0;
}
}

bool NeedsCounts(Estimator estimator)
{
  return estimator == Estimator::Published || estimator == Estimator::NearestPhotons;
}

bool NeedsWeights(Estimator estimator)
{
  return estimator == Estimator::Published;
}

Reconstruction::Reconstruction(Device& onDevice, const Domain& ofDomain, const NoisyLight& given, bool hasDirections,
  const ReconstructionSettings& itsSettings, const Monitor& itsMonitor)
  : device(onDevice)
  , domain(ofDomain)
  , settings(itsSettings)
  , monitor(itsMonitor)
  , directions(hasDirections)
  , levels(LevelsOf(ofDomain.Whole(), itsSettings.levels))
  , top(TopOf(itsSettings, this->levels))
  , blocks(ofDomain, std::min(LevelsOfBox, this->top), MarginOf(itsSettings.estimator),
      EdgeOf(itsSettings.estimator, std::min(LevelsOfBox, this->top)))
  , light(this->Gathered(given))
{
  this->Check(given);
}

NoisyLight Reconstruction::Gathered(const NoisyLight& given)
{
  NoisyLight of = given;
  of.grid = this->blocks.GridOf(this->blocks.Box().size);
  const auto gather = [&](const float*& values, int components, bool needed, std::vector<float>& stored) {
    values = needed ? this->blocks.Gather(values, components, stored) : nullptr;
  };
  const Estimator estimator = this->settings.estimator;
  gather(of.batchFluence, given.batches * given.channels, this->IsConservative(), this->Storage[0]);
  gather(of.fluence, given.channels, !this->IsConservative(), this->Storage[0]);
  gather(of.meanDirection, 3, this->directions, this->Storage[1]);
  gather(of.photonCount, 1, NeedsCounts(estimator), this->Storage[2]);
  gather(of.photonWeight, 1, NeedsWeights(estimator), this->Storage[3]);
  return of;
}

void Reconstruction::Check(const NoisyLight& given)
{
  constexpr float LongestDirection = 1.001f; // rounding may make a component of a unit vector a little longer than 1
  ArrayRange range;
  this->OnVoxels([&] {
    range = this->IsConservative()
      ? CheckedRange(
          this->domain, given.batchFluence, given.batches * given.channels, given.channels, "fluence_batches")
      : CheckedRange(this->domain, given.fluence, given.channels, given.channels, "fluence");
    if (this->directions)
    {
      CheckedRange(this->domain, given.meanDirection, 3, 3, "mean_direction", -LongestDirection, LongestDirection);
    }
    if (NeedsCounts(this->settings.estimator))
    {
      CheckedRange(this->domain, given.photonCount, 1, 1, "photon_count");
    }
    if (NeedsWeights(this->settings.estimator))
    {
      CheckedRange(this->domain, given.photonWeight, 1, 1, "photon_weight");
    }
  });
  this->largest = static_cast<float>(this->domain.Max(range.largest));
  this->total = this->domain.Sum(range.total);
}

std::array<float, 3> Reconstruction::Conserve(ReconstructedLight& result) const
{
  const std::array<double, 3> found =
    this->domain.Sum(TotalOf(result.fluence.data(), this->blocks.Box(), this->domain.Own(), this->light.channels));
  const double sets = this->IsConservative() ? this->light.batches : 1.0;
  std::array<float, 3> factors = { 1.0f, 1.0f, 1.0f };
  double before = 0.0, after = 0.0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(this->light.channels); ++c)
  {
    const double was = this->total[c] / sets;
    before += was;
    after += found[c];
    if (this->settings.conserve && found[c] > 0.0)
    {
      factors[c] = static_cast<float>(was / found[c]);
    }
  }
  result.bias = before > 0.0 ? after / before - 1.0 : 0.0;
  return factors;
}

ReconstructedLight Reconstruction::MakeRoom() const
{
  const std::size_t voxels = this->light.grid.VoxelCount();
  const std::size_t values = CountOf(voxels, this->light.channels, true);
  ReconstructedLight result;
  MakeZeros({ { &result.fluence, values }, { &result.mipLevel, voxels },
    { &result.fluenceError, this->IsConservative() ? values : 0 },
    { &result.meanDirection, CountOf(voxels, 3, this->directions) } });
  return result;
}

void Reconstruction::Crop(ReconstructedLight& result) const
{
  this->blocks.Crop(result.fluence, this->light.channels);
  this->blocks.Crop(result.fluenceError, this->light.channels);
  this->blocks.Crop(result.mipLevel, 1);
  this->blocks.Crop(result.meanDirection, 3);
}

namespace
{
const char* NameOf(Estimator estimator)
{
  switch (estimator)
  {
    case Estimator::Published: return "published";
    case Estimator::Conservative: return "conservative";
    case Estimator::ConstantRadius: return "constant radius";
    default: return "nearest photons";
  }
}

void RequireArray(const float* values, Estimator estimator, const char* what, const char* advice)
{
  Require(
    values, "There is no " + std::string(what) + ", which the " + NameOf(estimator) + " estimator needs. " + advice);
}

/// Checks the settings.
/// @throws InvalidInput if a setting is out of range
void Check(const ReconstructionSettings& settings)
{
  const auto require = [](bool fits, const std::string& what, double value, const std::string& range) {
    if (!fits)
    {
      throw InvalidInput(what + " is " + Text("%g", value) + "; it must be " + range + ".");
    }
  };
  const std::string most = std::to_string(LevelsAtMost);
  require(
    settings.levels >= 1 && settings.levels <= LevelsAtMost, "The number of levels", settings.levels, "1 to " + most);
  require(settings.level >= 0 && settings.level <= LevelsAtMost, "The level of the constant radius", settings.level,
    "0 to " + most);
  require(settings.nearest >= 1, "The number of nearest photons", settings.nearest, "at least 1");
  require(settings.weightStep >= 0.0 && std::isfinite(settings.weightStep), "The weight of photons from level to level",
    settings.weightStep, "a number of 0 (found from the photons) or more");
}

/// Checks that the light has all inputs of the estimator.
/// @throws InvalidInput if an input of the estimator is missing; names it
void CheckPresence(const NoisyLight& light, Estimator estimator)
{
  Require(light.channels == 1 || light.channels == 3,
    "The light has " + std::to_string(light.channels) + " channels; it must have 1 (grey) or 3 (RGB).");
  if (estimator == Estimator::Conservative)
  {
    const char* advice =
      "Let PhotonEmitter make at least two Batches and PhotonMarcher's conservative scheme gather them, or "
      "choose another estimator.";
    RequireArray(light.batchFluence, estimator, "fluence_batches", advice);
    if (light.batches < 2 || light.batches > ComparedBatchesAtMost)
    {
      throw InvalidInput("The photons are of " + std::to_string(light.batches) +
        (light.batches == 1 ? " batch" : " batches") + "; the conservative estimator compares 2 to " +
        std::to_string(ComparedBatchesAtMost) + " of them. " + advice);
    }
    return;
  }
  RequireArray(light.fluence, estimator, "fluence", "Give it the light of PhotonMarcher.");
  const char* advice = "Switch on PhotonCounts of PhotonMarcher, or choose another estimator.";
  if (NeedsCounts(estimator))
  {
    RequireArray(light.photonCount, estimator, "photon_count", advice);
  }
  if (NeedsWeights(estimator))
  {
    RequireArray(light.photonWeight, estimator, "photon_weight", advice);
  }
}

/// Checks that the host's memory is approximately sufficient for the result and, if the device is a CPU, for
/// intermediate arrays.
void RequireMemory(const Device& device, const NoisyLight& light, bool conservative, std::size_t voxels)
{
  const double direction = light.meanDirection ? 3.0 : 0.0;
  const double result = light.channels * (conservative ? 2.0 : 1.0) + direction + 1.0;
  const double made =
    conservative ? 2.0 * (light.batches + light.channels + direction) + 9.0 : 8.0 * (light.channels + direction + 2.0);
  RequireHostMemory(sizeof(float) * static_cast<double>(voxels) * (result + (device.IsCpu() ? made / 7.0 : 0.0)),
    "Reconstructing light on " + std::to_string(voxels) + " voxels", "Use a coarser grid or fewer batches.");
}

/// Sets channels and batches on ranks without voxels to the values of the other ranks. Returns whether the light has
/// mean directions. Collective.
/// @throws InvalidInput if ranks disagree
bool AgreeOnKind(const Domain& domain, NoisyLight& light)
{
  const bool has = !domain.IsEmpty();
  RequireSame(domain.Comm(), "channels, batches and directions of light", has,
    { 1.0 * light.channels, 1.0 * light.batches, light.meanDirection ? 1.0 : 0.0 });
  light.channels = static_cast<int>(domain.Max(has ? light.channels : 0));
  light.batches = static_cast<int>(domain.Max(has ? light.batches : 0));
  return domain.Any(has && light.meanDirection);
}

/// Whether light of three channels has the same colour everywhere, so that its channels have the same noise.
/// Collective.
bool IsOneColour(const Domain& domain, const NoisyLight& light)
{
  constexpr float part = 1e-4f;
  const std::size_t count = domain.Own().VoxelCount() * static_cast<std::size_t>(light.batches);
  const auto sum = [](const float* rgb) { return rgb[0] + rgb[1] + rgb[2]; };
  const float* brightest = count > 0 ? light.batchFluence : nullptr;
  for (std::size_t i = 0; i < count; ++i)
  {
    const float* rgb = light.batchFluence + 3 * i;
    brightest = sum(rgb) > sum(brightest) ? rgb : brightest;
  }
  const double most = domain.Max(brightest ? sum(brightest) : -1.0);
  const bool isMost = brightest && sum(brightest) == most;
  const bool isFirst = -domain.Max(isMost ? -domain.Rank() : -domain.Comm().Ranks()) == domain.Rank();
  std::array<double, 3> own = {};
  if (isFirst && most > 0.0)
  {
    std::transform(brightest, brightest + 3, own.begin(), [&](float value) { return value / most; });
  }
  const std::array<double, 3> colour = domain.Sum(own);
  bool differs = false;
  for (std::size_t i = 0; i < count && most > 0.0 && !differs; ++i)
  {
    const float* rgb = light.batchFluence + 3 * i;
    for (std::size_t c = 0; c < 3; ++c)
    {
      differs |= std::abs(rgb[c] - sum(rgb) * static_cast<float>(colour[c])) > part * sum(rgb);
    }
  }
  return !domain.Any(differs);
}

/// Reconstructs each channel separately as grey light, with its own gains (fractions of detail that are kept) and
/// errors. Directions and source levels remain those of the sum of channels. Collective.
void ReconstructChannels(Device& device, const Domain& domain, const NoisyLight& light,
  const ReconstructionSettings& settings, const Monitor& monitor, ReconstructedLight& result)
{
  const std::size_t voxels = domain.Own().VoxelCount();
  std::vector<float> values(voxels * static_cast<std::size_t>(light.batches));
  NoisyLight one = light;
  one.channels = 1;
  one.fluence = one.meanDirection = nullptr;
  one.batchFluence = values.data();
  double before = 0.0, after = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      values[i] = light.batchFluence[3 * i + c];
    }
    const double total = domain.Sum(std::accumulate(values.begin(), values.end(), 0.0));
    const ReconstructedLight channel = Reconstruct(device, domain, one, settings, monitor);
    before += total;
    after += total * (1.0 + channel.bias);
    for (std::size_t i = 0; i < voxels; ++i)
    {
      result.fluence[3 * i + c] = channel.fluence[i];
      result.fluenceError[3 * i + c] = channel.fluenceError[i];
    }
  }
  result.bias = before > 0.0 ? after / before - 1.0 : 0.0;
}

void SayWhatIsLeftOut(const NoisyLight& light, bool directions, ReconstructedLight& result)
{
  if (!directions)
  {
    result.leftOut.push_back("mean direction: there is none");
  }
  if (light.channels == 1)
  {
    result.leftOut.push_back(left_out::Grey);
  }
}
}

ReconstructedLight Reconstruct(Device& device, const Domain& domain, const NoisyLight& given,
  const ReconstructionSettings& settings, const Monitor& monitor)
{
  const bool conservative = settings.estimator == Estimator::Conservative;
  domain.Collective([&] {
    Check(domain.Whole());
    domain.Partition().Check();
    Check(settings);
    if (!domain.IsEmpty())
    {
      CheckPresence(given, settings.estimator);
      RequireMemory(device, given, conservative, domain.Own().VoxelCount());
    }
    Report(monitor, 0.0);
  });
  RequireSame(domain.Comm(), "settings", true,
    { 1.0 * static_cast<int>(settings.estimator), 1.0 * settings.levels, settings.weightStep, 1.0 * settings.level,
      1.0 * settings.nearest, 1.0 * settings.conserve, 1.0 * settings.leaveOut });
  NoisyLight light = given;
  const bool directions = AgreeOnKind(domain, light);
  ReconstructedLight result;
  {
    const Reconstruction task(device, domain, light, directions, settings, monitor);
    result = task.MakeRoom();
    if (conservative)
    {
      ReconstructConservative(task, result);
    }
    else
    {
      ReconstructFromLevels(task, light.photonWeight, result);
    }
    task.Crop(result);
  }
  if (conservative && light.channels == 3)
  {
    if (settings.leaveOut && IsOneColour(domain, light))
    {
      result.leftOut.emplace_back(left_out::OneColourOfLight);
    }
    else
    {
      ReconstructChannels(device, domain, light, settings, monitor, result);
    }
  }
  SayWhatIsLeftOut(light, directions, result);
  result.device = device.Name();
  return result;
}
}
