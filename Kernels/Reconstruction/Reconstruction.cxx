#include "Reconstruction/Reconstruction.h"

#include "Device/Errors.h"
#include "Device/HostMemory.h"
#include "Device/HostThreads.h"
#include "Medium/Medium.h"
#include "Numerics/NumberText.h"
#include "Numerics/PyramidLayout.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
using Estimator = ReconstructionSettings::Estimator;

/// Number of pyramid levels that each rank computes from its own box.
constexpr int LevelsOfBox = 2;

/// Width in voxels of the halo that these levels need. Conservative: per level one cell of the level above for
/// interpolation, four for gains and errors, two for details and the levels they are computed from. Other estimators:
/// light lies between cells of a level, one more on either side, each of which depends on two cells below and on four
/// in all.
int MarginOf(Estimator estimator)
{
  return estimator == Estimator::Conservative ? 32 : 16;
}

/// Boxes begin at multiples of this number of voxels; for the other estimators 8, the width of a vector.
int EdgeOf(Estimator estimator, int shared)
{
  return estimator == Estimator::Conservative ? 1 << shared : 8;
}

/// Number of levels above a grid, at most `levels`.
int LevelsOf(const Grid& grid, int levels)
{
  return std::max(std::min(levels, PyramidLayout(grid.size).Top()), 1); // above a single voxel: itself
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

/// Summary of an array's values.
struct ArrayRange
{
  bool fit = true; ///< every value lies within the required range
  float largest = 0.0f;
  std::array<double, 3> total = {}; ///< of each component; only [0] if there is one
};

/// Accumulates several sums in parallel, because a single sum waits for each of its additions.
ArrayRange RangeOf(const float* values, std::size_t count, std::size_t components, float low, float high)
{
  constexpr std::size_t Lanes = 12; // a multiple of each number of components
  double sums[Lanes] = {};
  float largest[Lanes] = {};
  int unfit[Lanes] = {};
  const auto add = [&](std::size_t i, std::size_t lane) {
    const float value = values[i];
    sums[lane] += value;
    largest[lane] = value > largest[lane] ? value : largest[lane];
    unfit[lane] |= !(value >= low) | !(value <= high);
  };
  const std::size_t whole = count / Lanes * Lanes;
  for (std::size_t i = 0; i < whole; i += Lanes)
  {
    for (std::size_t lane = 0; lane < Lanes; ++lane)
    {
      add(i + lane, lane);
    }
  }
  for (std::size_t i = whole; i < count; ++i)
  {
    add(i, i - whole);
  }
  ArrayRange range;
  for (std::size_t lane = 0; lane < Lanes; ++lane)
  {
    range.fit &= unfit[lane] == 0;
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

/// @param width  values per voxel: the components of one batch or of several
/// @throws InvalidInput for an invalid value; names the voxel of the whole grid
ArrayRange CheckedRange(const Domain& domain, const float* values, int width, int components, const char* name,
  float low = 0.0f, float high = std::numeric_limits<float>::max())
{
  const std::size_t count = domain.Own().VoxelCount() * static_cast<std::size_t>(width);
  const ArrayRange range = RangeInThreads(values, count, components, low, high);
  if (!range.fit)
  {
    const float* const unfit =
      std::find_if_not(values, values + count, [&](float value) { return value >= low && value <= high; });
    std::array<int, 3> voxel =
      domain.OwnGrid().VoxelAt(static_cast<std::size_t>(unfit - values) / static_cast<std::size_t>(width));
    for (int axis = 0; axis < 3; ++axis)
    {
      voxel[axis] += domain.Own().first[axis];
    }
    throw InvalidInput(std::string(name) + " is " + Text("%g", *unfit) + " in voxel " +
      VoxelName(domain.Whole(), domain.Whole().IndexOf(voxel)) + " (the first such voxel); it must be finite and " +
      (low < 0.0f ? "no longer than 1." : "not negative.") + " Clean the light, or march the photons anew.");
  }
  return range;
}

/// The total of each channel over a part of a box.
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
  constexpr float LongestDirection = 1.001f; // rounding may make a unit vector's component a little longer than 1
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
}
