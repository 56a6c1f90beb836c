#include "Reconstruction/Reconstruction.h"

#include "Device/Batches.h"
#include "Device/Defines.h"
#include "Device/HostMappedBuffer.h"
#include "Device/HostThreads.h"
#include "Device/Sizes.h"
#include "Reconstruction/LightPyramid.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace tyndall
{
namespace
{
using Estimator = ReconstructionSettings::Estimator;

constexpr std::size_t FirstPart = std::size_t(1) << 18; // voxels in the first launch, until its run time is known

/// How the pyramids of light, counts and weights are built.
constexpr LightPyramid::Down Downs[] = { LightPyramid::Down::Gauss, LightPyramid::Down::Sum,
  LightPyramid::Down::MeanOfLit };

std::size_t CountOf(const Reconstruction& task, const float* values, int components)
{
  return values ? task.light.grid.VoxelCount() * Count(components) : 0;
}

/// Computes the light of each voxel from one level of its pyramid (all estimators except the conservative one).
class LevelPasses
{
public:
  /// @param task, result  must outlive this object; the result's arrays have the size of the box
  LevelPasses(const Reconstruction& task, ReconstructedLight& result);

  void Build(); ///< builds the pyramids up to the shared level
  /// Cells of a pyramid's shared level: those of this rank's box, and those of the whole grid.
  std::vector<float> Shared(std::size_t pyramid) const { return this->Pyramids[pyramid].Read(this->Part.shared); }
  void BuildAbove(std::size_t pyramid, const std::vector<float>& cells);

  void Choose(double weightStep); ///< light, levels and directions of the result

private:
  void Fill(std::size_t pyramid, const HostMappedBuffer<float>& array, int components, int first, const char* what);
  void InParts(const cl::Kernel& kernel) const;
  cl::Kernel Kernel(const char* name) const;

  const Reconstruction& Task;
  ReconstructedLight& Result;
  const std::array<int, 3>& Size;
  RowKernels Kernels;
  const PartOfPyramid Part;
  std::vector<LightPyramid> Pyramids;                         ///< those of FieldsOfPyramids
  HostMappedBuffer<float> Light, Directions, Counts, Weights; ///< of photons; without values where not needed
};

/// The increment of photon weight per level. If it is not given, the mean weight of lit voxels, reduced by the rounding
/// of weights in the march, so that equal weights all reach the first increment. Collective.
/// @param own  weights of the block's voxels
double WeightStepOf(const Reconstruction& task, const float* own)
{
  double total = 0.0, lit = 0.0;
  const std::size_t voxels = NeedsWeights(task.settings.estimator) ? task.domain.Own().VoxelCount() : 0;
  if (voxels > 0)
  {
    total = SumInThreads(voxels, 1 << 16,
      [&](std::size_t begin, std::size_t end) { return std::accumulate(own + begin, own + end, 0.0); });
    lit = static_cast<double>(voxels) - static_cast<double>(std::count(own, own + voxels, 0.0f));
  }
  total = task.domain.Sum(total);
  lit = task.domain.Sum(lit);
  return task.settings.weightStep > 0.0 ? task.settings.weightStep : total > 0.0 ? 0.999 * total / lit : 1.0;
}

/// Number of fields of each pyramid that an estimator uses: light and directions, photon counts, photon weights.
std::vector<int> FieldsOfPyramids(const Reconstruction& task)
{
  std::vector<int> fields = { task.Fields() };
  fields.resize(NeedsWeights(task.settings.estimator) ? 3 : NeedsCounts(task.settings.estimator) ? 2 : 1, 1);
  return fields;
}

LevelPasses::LevelPasses(const Reconstruction& task, ReconstructedLight& result)
  : Task(task)
  , Result(result)
  , Size(task.light.grid.size)
  , Kernels(task.device, RowWidth(task.device, task.domain.Whole()))
  , Part{ task.domain.Whole().size, task.blocks.Box().first, task.blocks.Shared() }
  , Light(task.device, task.light.fluence, CountOf(task, task.light.fluence, task.light.channels), "fluence")
  , Directions(task.device, task.light.meanDirection, CountOf(task, task.light.meanDirection, 3), "mean directions")
  , Counts(task.device, task.light.photonCount, CountOf(task, task.light.photonCount, 1), "photon_count")
  , Weights(task.device, task.light.photonWeight, CountOf(task, task.light.photonWeight, 1), "photon_weight")
{
  const char* const what[] = { "the pyramid of light", "the pyramid of photon counts", "the pyramid of weights" };
  for (const int fields : FieldsOfPyramids(task))
  {
    this->Pyramids.emplace_back(
      this->Kernels, task.light.grid, fields, task.top, what[this->Pyramids.size()], this->Part);
  }
}

cl::Kernel LevelPasses::Kernel(const char* name) const
{
  const Estimator estimator = this->Task.settings.estimator;
  return this->Kernels.Kernel(name, kernel_source::LevelReconstruction,
    Define("CHANNELS", this->Task.light.channels) + Define("DIRECTIONS", this->Task.directions) +
      Define("PUBLISHED", estimator == Estimator::Published) +
      Define("CONSTANT_RADIUS", estimator == Estimator::ConstantRadius) + Define("TOP", this->Task.top));
}

void LevelPasses::Fill(
  std::size_t pyramid, const HostMappedBuffer<float>& array, int components, int first, const char* what)
{
  this->Pyramids[pyramid].Fill({ this->Kernels, array, this->Size, 1, components, false, what }, components, first);
}

void LevelPasses::Build()
{
  const int channels = this->Task.light.channels;
  this->Fill(0, this->Light, channels, 0, "fluence");
  if (this->Task.directions)
  {
    this->Fill(0, this->Directions, 3, channels, "mean directions");
  }
  if (this->Pyramids.size() > 1)
  {
    this->Fill(1, this->Counts, 1, 0, "photon counts");
  }
  if (this->Pyramids.size() > 2)
  {
    this->Fill(2, this->Weights, 1, 0, "weights");
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
  std::vector<float>& fluence = this->Result.fluence;
  const HostMappedBuffer<float> found(device, fluence.data(), fluence.size(), "fluence");
  const HostMappedBuffer<float> direction(device, ways.data(), ways.size(), "directions");
  const HostMappedBuffer<float> chosen(device, levels.data(), levels.size(), "levels");
  const int volumes = this->Task.directions ? 1 : 0;
  const WholeRows fluenceRows(this->Kernels, found, this->Size, 1, this->Task.light.channels, true, "fluence");
  const WholeRows directionRows(this->Kernels, direction, this->Size, volumes, 3, true, "mean directions");
  const WholeRows chosenRows(this->Kernels, chosen, this->Size, 1, 1, true, "levels");

  // Arguments that an estimator does not use may be any buffer.
  const LightPyramid& light = this->Pyramids.front();
  const LightPyramid& heavy = this->Pyramids.back();
  const LightPyramid& photons = this->Pyramids[std::min<std::size_t>(1, this->Pyramids.size() - 1)];
  cl::Kernel choose = this->Kernel("choose_level");
  With(choose, light.Values(), light.Levels(), photons.Values(), heavy.Values(), photons.Levels(),
    cl_float(this->Task.settings.estimator == Estimator::Published ? weightStep : this->Task.settings.nearest),
    fluenceRows.Handle(), directionRows.Handle(), chosenRows.Handle(), VoxelLayout(this->Size, this->Kernels.Width()));
  this->InParts(choose);
  fluenceRows.Fetch();
  chosenRows.Fetch();
  if (this->Task.directions)
  {
    directionRows.Fetch();
  }
}

/// Computes the pyramids from the shared level on.
void CompletePyramids(const Reconstruction& task, std::optional<LevelPasses>& passes)
{
  const std::vector<int> fields = FieldsOfPyramids(task);
  for (std::size_t pyramid = 0; pyramid < fields.size(); ++pyramid)
  {
    std::vector<float> cells;
    task.OnVoxels([&] { cells = passes->Shared(pyramid); });
    cells = task.blocks.GatherCells(cells, fields[pyramid]);
    task.OnVoxels([&] { passes->BuildAbove(pyramid, cells); });
  }
}
}

void ReconstructFromLevels(const Reconstruction& task, const float* ownWeights, ReconstructedLight& result)
{
  const double step = WeightStepOf(task, ownWeights);
  std::optional<LevelPasses> passes;
  task.OnVoxels([&] {
    passes.emplace(task, result);
    passes->Build();
  });
  if (task.top > task.blocks.Shared())
  {
    CompletePyramids(task, passes);
  }
  task.OnVoxels([&] { passes->Choose(step); });
  const std::array<float, 3> factors = task.Conserve(result);
  const auto channels = static_cast<std::size_t>(task.light.channels);
  InThreads(result.fluence.size() / channels, 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * channels; i < end * channels; ++i)
    {
      result.fluence[i] *= factors[i % channels];
    }
  });
}
}
