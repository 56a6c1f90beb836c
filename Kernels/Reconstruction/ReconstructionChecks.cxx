#include "Reconstruction/ReconstructionChecks.h"

#include "Device/HostMemory.h"
#include "Light/LeftOut.h"
#include "Medium/Medium.h"
#include "Numerics/NumberText.h"
#include "Numerics/PyramidLayout.h"
#include "Reconstruction/LightPyramidShared.h"

#include <algorithm>
#include <cmath>
#include <string>

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
}

bool NeedsCounts(Estimator estimator)
{
  return estimator == Estimator::Published || estimator == Estimator::NearestPhotons;
}

bool NeedsWeights(Estimator estimator)
{
  return estimator == Estimator::Published;
}

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

void CheckPresence(const NoisyLight& light, Estimator estimator)
{
  tyndall::Medium volume;
  volume.grid = light.grid;
  tyndall::Check(volume); // of its grid
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

int LevelsOf(const Grid& grid, int levels)
{
  return std::max(std::min(levels, PyramidLayout(grid.size).Top()), 1); // above a single voxel: itself
}

ReconstructedLight MakeRoom(const NoisyLight& light, bool conservative)
{
  const std::size_t voxels = light.grid.VoxelCount();
  const std::size_t values = voxels * static_cast<std::size_t>(light.channels);
  ReconstructedLight result;
  MakeZeros(
    { { &result.fluence, values }, { &result.mipLevel, voxels }, { &result.fluenceError, conservative ? values : 0 },
      { &result.meanDirection, light.meanDirection ? 3 * voxels : 0 } });
  return result;
}

void SayWhatIsLeftOut(const NoisyLight& light, ReconstructedLight& result)
{
  if (!light.meanDirection)
  {
    result.leftOut.push_back("mean direction: there is none");
  }
  if (light.channels == 1)
  {
    result.leftOut.push_back(left_out::Grey);
  }
}
}
