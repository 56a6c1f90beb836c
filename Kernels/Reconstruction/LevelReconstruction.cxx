#include "Reconstruction/LevelReconstruction.h"

#include "Device/Batches.h"
#include "Device/Defines.h"
#include "Device/HostThreads.h"
#include "Device/Sizes.h"
#include "Reconstruction/ReconstructionChecks.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tyndall
{
namespace
{
using Estimator = ReconstructionSettings::Estimator;

constexpr std::size_t FirstPart = std::size_t(1) << 18; // voxels per launch, until it is known how long that takes

/// Of light, counts and weights.
constexpr LightPyramid::Down Downs[] = { LightPyramid::Down::Gauss, LightPyramid::Down::Sum,
  LightPyramid::Down::MeanOfLit };

std::size_t VoxelsOf(const Reconstruction& task, bool needed)
{
  return needed ? task.light.grid.VoxelCount() : 0;
}
}

PhotonsOfVoxels::PhotonsOfVoxels(const Reconstruction& task)
  : counts(task.device, task.light.photonCount, VoxelsOf(task, NeedsCounts(task.settings.estimator)), "photon_count")
  , weights(
      task.device, task.light.photonWeight, VoxelsOf(task, NeedsWeights(task.settings.estimator)), "photon_weight")
{
}

WeightsOfVoxels::WeightsOfVoxels(const float* values, std::size_t voxels)
{
  constexpr std::size_t piece = 1 << 16;
  this->total = SumInThreads(voxels, piece,
    [&](std::size_t begin, std::size_t end) { return std::accumulate(values + begin, values + end, 0.0); });
  this->lit = static_cast<double>(voxels) - static_cast<double>(std::count(values, values + voxels, 0.0f));
}

double WeightStepOf(const ReconstructionSettings& settings, const WeightsOfVoxels& weights)
{
  const double mean = weights.total > 0.0 ? 0.999 * weights.total / weights.lit : 1.0;
  return settings.weightStep > 0.0 ? settings.weightStep : mean;
}

int TopLevelOf(const ReconstructionSettings& settings, int levels)
{
  return settings.estimator == Estimator::ConstantRadius ? std::min(settings.level, levels) : levels;
}

std::vector<int> FieldsOfPyramids(Estimator estimator, int channels, bool directions)
{
  std::vector<int> fields = { channels + (directions ? 3 : 0) };
  fields.resize(NeedsWeights(estimator) ? 3 : NeedsCounts(estimator) ? 2 : 1, 1);
  return fields;
}

LevelPasses::LevelPasses(const Reconstruction& task, const PhotonsOfVoxels& photons, ReconstructedLight& result,
  int width, const PartOfPyramid& part)
  : Task(task)
  , Photons(photons)
  , Result(result)
  , Size(task.light.grid.size)
  , HasDirections(task.light.meanDirection != nullptr)
  , Published(task.settings.estimator == Estimator::Published)
  , ConstantRadius(task.settings.estimator == Estimator::ConstantRadius)
  , Top(TopLevelOf(task.settings, task.levels))
  , Kernels(task.device, width)
  , Part(part)
  , Fluence(task.device, result.fluence.data(), result.fluence.size(), "fluence")
{
  const char* const what[] = { "the pyramid of light", "the pyramid of photon counts", "the pyramid of weights" };
  for (const int fields : FieldsOfPyramids(task.settings.estimator, task.light.channels, this->HasDirections))
  {
    this->Pyramids.emplace_back(
      this->Kernels, task.light.grid, fields, this->Top, what[this->Pyramids.size()], this->Part);
  }
}

cl::Kernel LevelPasses::Kernel(const char* name) const
{
  return this->Kernels.Kernel(name, kernel_source::LevelReconstruction,
    Define("CHANNELS", this->Task.light.channels) + Define("DIRECTIONS", this->HasDirections) +
      Define("PUBLISHED", this->Published) + Define("CONSTANT_RADIUS", this->ConstantRadius) +
      Define("TOP", this->Top));
}

void LevelPasses::Fill(
  std::size_t pyramid, const HostMappedBuffer<float>& array, int components, int first, const char* what)
{
  this->Pyramids[pyramid].Fill({ this->Kernels, array, this->Size, 1, components, false, what }, components, first);
}

void LevelPasses::Build()
{
  const int channels = this->Task.light.channels;
  this->Fill(0, this->Task.fluence, channels, 0, "fluence");
  if (this->HasDirections)
  {
    this->Fill(0, this->Task.direction, 3, channels, "mean directions");
  }
  if (this->Pyramids.size() > 1)
  {
    this->Fill(1, this->Photons.counts, 1, 0, "photon counts");
  }
  if (this->Pyramids.size() > 2)
  {
    this->Fill(2, this->Photons.weights, 1, 0, "weights");
  }
  for (std::size_t pyramid = 0; pyramid < this->Pyramids.size(); ++pyramid)
  {
    this->Pyramids[pyramid].Build(Downs[pyramid]);
  }
}

void LevelPasses::BuildAbove(std::size_t pyramid, const std::vector<float>& cells)
{
  this->Pyramids[pyramid].BuildAbove(Downs[pyramid], cells);
}

void LevelPasses::InParts(const cl::Kernel& kernel) const
{
  Batches parts;
  parts.count = Count(this->Size[2]);
  parts.first = std::max<std::size_t>(FirstPart / (Count(this->Size[0]) * Count(this->Size[1])), 1);
  parts.from = 0.2;
  InBatches(this->Task.device, parts, this->Task.monitor,
    [&](std::size_t first, std::size_t layers) { this->Kernels.Run(kernel, this->Size, first, layers); });
}

void LevelPasses::Choose(double weightStep)
{
  Device& device = this->Task.device;
  std::vector<float>& ways = this->Result.meanDirection;
  std::vector<float>& levels = this->Result.mipLevel;
  const HostMappedBuffer<float> direction(device, ways.data(), ways.size(), "directions");
  const HostMappedBuffer<float> chosen(device, levels.data(), levels.size(), "levels");
  const int volumes = this->HasDirections ? 1 : 0;
  const WholeRows fluenceRows(this->Kernels, this->Fluence, this->Size, 1, this->Task.light.channels, true, "fluence");
  const WholeRows directionRows(this->Kernels, direction, this->Size, volumes, 3, true, "mean directions");
  const WholeRows chosenRows(this->Kernels, chosen, this->Size, 1, 1, true, "levels");

  // What an estimator does not look at is any.
  const LightPyramid& light = this->Pyramids.front();
  const LightPyramid& heavy = this->Pyramids.back();
  const LightPyramid& photons = this->Pyramids[std::min<std::size_t>(1, this->Pyramids.size() - 1)];
  cl::Kernel choose = this->Kernel("choose_level");
  With(choose, light.Values(), light.Levels(), photons.Values(), heavy.Values(), photons.Levels(),
    cl_float(this->Published ? weightStep : this->Task.settings.nearest), fluenceRows.Handle(), directionRows.Handle(),
    chosenRows.Handle(), VoxelLayout(this->Size, this->Kernels.Width()));
  this->InParts(choose);
  fluenceRows.Fetch();
  chosenRows.Fetch();
  if (this->HasDirections)
  {
    directionRows.Fetch();
  }
}

void LevelPasses::Conserve()
{
  const std::vector<float>& found = this->Result.fluence;
  const ArrayRange range = RangeOf(this->Task.device, this->Fluence, found.data(), found.size(),
    this->Task.light.channels, 0.0f, std::numeric_limits<float>::max());
  const std::array<float, 3> factors = this->Task.Conserve(range.total, this->Result);
  if (this->Task.settings.conserve)
  {
    cl::Kernel scale = this->Kernel("scale_light");
    With(scale, this->Fluence.Handle(), cl_float4{ { factors[0], factors[1], factors[2], 0.0f } });
    this->Task.device.Queue().enqueueNDRangeKernel(
      scale, cl::NullRange, cl::NDRange(this->Task.light.grid.VoxelCount()), cl::NullRange);
    this->Fluence.Fetch();
  }
}
}
