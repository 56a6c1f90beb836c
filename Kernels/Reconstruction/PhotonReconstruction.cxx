#include "Reconstruction/PhotonReconstruction.h"

#include "Device/Clock.h"
#include "Device/HostMemory.h"
#include "Medium/Medium.h"
#include "Medium/Traits.h"
#include "Numerics/NumberText.h"
#include "Numerics/PyramidLayout.h"
#include "Reconstruction/ConservativeReconstruction.h"
#include "Reconstruction/LevelReconstruction.h"
#include "Reconstruction/LightRows.h"
#include "Reconstruction/ReconstructionChecks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tyndall
{
namespace
{
using Estimator = ReconstructionSettings::Estimator;

constexpr float Most = std::numeric_limits<float>::max();
constexpr float LongestDirection = 1.001f; // rounding may make a unit vector's component a little longer than 1

/// What an array holds, once it is known that all of it means something.
ArrayRange Checked(Device& device, const HostMappedBuffer<float>& array, const float* values, std::size_t count,
  int components, const Grid& grid, const char* name, float low, float high)
{
  const std::size_t width = count / grid.VoxelCount(); // of a voxel: components of one batch or of several
  const ArrayRange range = RangeOf(device, array, values, count, components, low, high);
  if (range.unfit)
  {
    const std::size_t voxel = *range.unfit / width;
    throw InvalidInput(std::string(name) + " is " + Text("%g", values[*range.unfit]) + " in voxel " +
      VoxelName(grid, voxel) + " (the first such voxel); it must be finite and " +
      (low < 0.0f ? "no longer than 1." : "not negative.") + " Clean the light, or march the photons anew.");
  }
  return range;
}

/// Of the result and of what is made on the way, roughly.
void RequireMemory(const Device& device, const NoisyLight& light, bool conservative)
{
  const double direction = light.meanDirection ? 3.0 : 0.0;
  const double result = light.channels * (conservative ? 2.0 : 1.0) + direction + 1.0;
  const double made =
    conservative ? 2.0 * (light.batches + light.channels + direction) + 9.0 : 8.0 * (light.channels + direction + 2.0);
  const double voxels = static_cast<double>(light.grid.VoxelCount());
  RequireHostMemory(sizeof(float) * voxels * (result + (device.IsCpu() ? made / 7.0 : 0.0)),
    "Reconstructing light on " + std::to_string(light.grid.VoxelCount()) + " voxels",
    "Use a coarser grid or fewer batches.");
}

/// Whether the light is of one colour everywhere, so that its channels share their noise.
bool OneColour(const NoisyLight& light)
{
  constexpr float part = 1e-4f;
  const std::size_t count = light.grid.VoxelCount() * static_cast<std::size_t>(light.batches);
  const float* brightest = light.batchFluence;
  const auto sum = [](const float* rgb) { return rgb[0] + rgb[1] + rgb[2]; };
  for (std::size_t i = 0; i < count; ++i)
  {
    const float* rgb = light.batchFluence + 3 * i;
    brightest = sum(rgb) > sum(brightest) ? rgb : brightest;
  }
  const float whole = sum(brightest);
  for (std::size_t i = 0; i < count && whole > 0.0f; ++i)
  {
    const float* rgb = light.batchFluence + 3 * i;
    for (int c = 0; c < 3; ++c)
    {
      if (std::abs(rgb[c] - sum(rgb) * (brightest[c] / whole)) > part * sum(rgb))
      {
        return false;
      }
    }
  }
  return true;
}

/// Each channel as grey light by itself: gains and errors of its own. Directions and levels stay those of all together.
void ReconstructChannels(Device& device, const NoisyLight& light, const ReconstructionSettings& settings,
  const Monitor& monitor, ReconstructedLight& result)
{
  const std::size_t voxels = light.grid.VoxelCount();
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
    const double total = std::accumulate(values.begin(), values.end(), 0.0);
    const ReconstructedLight channel = Reconstruct(device, one, settings, monitor);
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
}

std::array<float, 3> Reconstruction::Conserve(const std::array<double, 3>& total, ReconstructedLight& result) const
{
  const double sets = this->settings.estimator == Estimator::Conservative ? this->light.batches : 1.0;
  std::array<float, 3> factors = { 1.0f, 1.0f, 1.0f };
  double before = 0.0, after = 0.0;
  for (int c = 0; c < this->light.channels; ++c)
  {
    const double was = this->range.total[c] / sets;
    before += was;
    after += total[c];
    if (this->settings.conserve && total[c] > 0.0)
    {
      factors[c] = static_cast<float>(was / total[c]);
    }
  }
  result.bias = before > 0.0 ? after / before - 1.0 : 0.0;
  return factors;
}

namespace
{
/// By the estimators that take each voxel's light from one level.
void ReconstructFromLevels(const Reconstruction& task, ReconstructedLight& result)
{
  const NoisyLight& light = task.light;
  const std::size_t voxels = light.grid.VoxelCount();
  const PhotonsOfVoxels photons(task);
  WeightsOfVoxels weights;
  if (NeedsCounts(task.settings.estimator))
  {
    Checked(task.device, photons.counts, light.photonCount, voxels, 1, light.grid, "photon_count", 0.0f, Most);
  }
  if (NeedsWeights(task.settings.estimator))
  {
    Checked(task.device, photons.weights, light.photonWeight, voxels, 1, light.grid, "photon_weight", 0.0f, Most);
    weights = WeightsOfVoxels(light.photonWeight, voxels);
  }
  LevelPasses passes(task, photons, result, RowWidth(task.device, light.grid));
  passes.Build();
  passes.Choose(WeightStepOf(task.settings, weights));
  passes.Conserve();
}
}

ReconstructedLight Reconstruct(
  Device& device, const NoisyLight& light, const ReconstructionSettings& settings, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const bool conservative = settings.estimator == Estimator::Conservative;
  Check(settings);
  CheckPresence(light, settings.estimator);
  RequireMemory(device, light, conservative);
  Report(monitor, 0.0);

  const Grid& grid = light.grid;
  const std::size_t voxels = grid.VoxelCount();
  const std::size_t vectors = light.meanDirection ? 3 * voxels : 0;
  const float* given = conservative ? light.batchFluence : light.fluence;
  const std::size_t count = voxels * static_cast<std::size_t>(light.channels * (conservative ? light.batches : 1));
  ReconstructedLight result = MakeRoom(light, conservative);
  const HostMappedBuffer<float> fluence(device, given, count, "fluence");
  const HostMappedBuffer<float> direction(device, light.meanDirection, vectors, "mean directions");
  const ArrayRange range = Checked(
    device, fluence, given, count, light.channels, grid, conservative ? "fluence_batches" : "fluence", 0.0f, Most);
  if (vectors > 0)
  {
    Checked(
      device, direction, light.meanDirection, vectors, 3, grid, "mean_direction", -LongestDirection, LongestDirection);
  }
  const Reconstruction task = { device, light, settings, monitor, fluence, direction, range,
    LevelsOf(grid, settings.levels) };
  if (!conservative)
  {
    ReconstructFromLevels(task, result);
  }
  else
  {
    ReconstructConservative(task, result);
    if (light.channels == 3 && !OneColour(light))
    {
      ReconstructChannels(device, light, settings, monitor, result);
    }
  }
  SayWhatIsLeftOut(light, result);
  result.device = device.Name();
  result.seconds = ClockSeconds() - start;
  return result;
}
}
