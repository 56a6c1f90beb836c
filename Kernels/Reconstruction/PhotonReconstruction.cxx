#include "Reconstruction/PhotonReconstruction.h"

#include "Device/Clock.h"
#include "Device/Errors.h"
#include "Device/HostMemory.h"
#include "Distribution/SharedMedium.h"
#include "Light/LeftOut.h"
#include "Medium/Medium.h"
#include "Numerics/NumberText.h"
#include "Reconstruction/LightPyramidShared.h"
#include "Reconstruction/Reconstruction.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tyndall
{
namespace
{
using Estimator = ReconstructionSettings::Estimator;

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
  if (!values)
  {
    throw InvalidInput(
      "There is no " + std::string(what) + ", which the " + NameOf(estimator) + " estimator needs. " + advice);
  }
}

/// @throws InvalidInput where a setting is out of its range
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

/// @throws InvalidInput if an input of the estimator is missing; names it
void CheckPresence(const NoisyLight& light, Estimator estimator)
{
  if (light.channels != 1 && light.channels != 3)
  {
    throw InvalidInput(
      "The light has " + std::to_string(light.channels) + " channels; it must have 1 (grey) or 3 (RGB).");
  }
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

/// Approximate memory for intermediate arrays and the result.
void RequireMemory(const Device& device, const NoisyLight& light, bool conservative, std::size_t voxels)
{
  const double direction = light.meanDirection ? 3.0 : 0.0;
  const double result = light.channels * (conservative ? 2.0 : 1.0) + direction + 1.0;
  const double made =
    conservative ? 2.0 * (light.batches + light.channels + direction) + 9.0 : 8.0 * (light.channels + direction + 2.0);
  RequireHostMemory(sizeof(float) * static_cast<double>(voxels) * (result + (device.IsCpu() ? made / 7.0 : 0.0)),
    "Reconstructing light on " + std::to_string(voxels) + " voxels", "Use a coarser grid or fewer batches.");
}

/// Sets channels and batches on ranks without voxels to the values of the other ranks; returns whether there are mean
/// directions. Collective.
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

/// Whether light of three channels has the same colour everywhere, so that its channels share their noise. Collective.
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

/// Reconstructs each channel separately as grey light, with its own gains and errors; directions and levels remain
/// those of the sum. Collective.
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
  const double start = ClockSeconds();
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
      1.0 * settings.nearest, 1.0 * settings.conserve });
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
  if (conservative && light.channels == 3 && !IsOneColour(domain, light))
  {
    ReconstructChannels(device, domain, light, settings, monitor, result);
  }
  SayWhatIsLeftOut(light, directions, result);
  result.device = device.Name();
  result.seconds = ClockSeconds() - start;
  return result;
}
}
