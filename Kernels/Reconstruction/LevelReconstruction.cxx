#include "Reconstruction/Reconstruction.h"

#include "Device/Batches.h"
#include "Device/Device.h"
#include "Device/HostThreads.h"
#include "Device/Sizes.h"
#include "Reconstruction/LightPyramid.h"
#include "Reconstruction/LightPyramidShared.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace tyndall
{
namespace
{
using Estimator = ReconstructionSettings::Estimator;

// Number of voxels in the first launch of a kernel. Its run time determines the size of later launches.
constexpr std::size_t FirstPart = std::size_t(1) << 18;

/// Methods by which the pyramids are built: of light, of photon counts, of photon weights.
constexpr LightPyramid::Down Downs[] = { LightPyramid::Down::Gauss, LightPyramid::Down::Sum,
  LightPyramid::Down::MeanOfLit };

/// Passes that compute the light of each voxel from one level of a pyramid of light (all estimators except the
/// conservative one).
class LevelPasses
{
public:
  /// Allocates the pyramids.
  /// @param task, result  referenced; the result's arrays must have the size of this rank's box (its block and a halo)
  LevelPasses(const Reconstruction& task, ReconstructedLight& result);

  /// Computes the levels of all pyramids from the voxels up to the shared level, the coarsest one that a rank computes
  /// from its own box.
  void Build();
  /// Cells of a pyramid's shared level (the coarsest one that a rank computes from its own box) in this rank's box.
  /// @param pyramid  0: light; 1: photon counts; 2: photon weights
  std::vector<float> Shared(std::size_t pyramid) const { return this->Pyramids[pyramid].Read(this->Part.shared); }
  /// Computes the levels that are coarser than the shared level, the coarsest one that a rank computes from its own
  /// box.
  /// @param cells  cells of the shared level in the whole domain, gathered from all ranks
  void BuildAbove(std::size_t pyramid, const std::vector<float>& cells);

  /// Computes light, mean direction and source level (the pyramid level from which the light is taken) of each voxel.
  /// @param weightStep  for the published estimator: increment of photon weight per level
  void Choose(double weightStep);

private:
  void Fill(std::size_t pyramid, const float* values, int components, int first, const char* what);
  void InParts(const cl::Kernel& kernel) const;

  const Reconstruction& Task;
  ReconstructedLight& Result;
  const std::array<int, 3>& Size;
  RowKernels Kernels;
  const PartOfPyramid Part;
  /// Pyramids of light, photon counts and photon weights, as many as FieldsOfPyramids has elements.
  std::vector<LightPyramid> Pyramids;
};

/// Increment of photon weight per level: the value of the settings or, if they give none, 0.999 times the mean weight
/// of voxels with photons. The factor allows for the rounding of weights in the march: otherwise some of several equal
/// weights might fall below the first increment. Collective.
/// @param own  photon weights in the voxels of this rank's block
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

/// Number of fields (quantities per cell) of each pyramid that an estimator needs: light and directions, photon counts,
/// photon weights.
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
{
  const char* const what[] = { "the pyramid of light", "the pyramid of photon counts", "the pyramid of weights" };
  for (const int fields : FieldsOfPyramids(task))
  {
    this->Pyramids.emplace_back(
      this->Kernels, task.light.grid, fields, task.top, what[this->Pyramids.size()], this->Part);
  }
}

void LevelPasses::Fill(std::size_t pyramid, const float* values, int components, int first, const char* what)
{
  this->Pyramids[pyramid].Fill({ this->Kernels, values, this->Size, components, what }, components, first);
}

void LevelPasses::Build()
{
  const NoisyLight& light = this->Task.light;
  this->Fill(0, light.fluence, light.channels, 0, "fluence");
  if (this->Task.directions)
  {
    this->Fill(0, light.meanDirection, 3, light.channels, "mean directions");
  }
  if (this->Pyramids.size() > 1)
  {
    this->Fill(1, light.photonCount, 1, 0, "photon counts");
  }
  if (this->Pyramids.size() > 2)
  {
    this->Fill(2, light.photonWeight, 1, 0, "weights");
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
  ReconstructedLight& result = this->Result;
  const WholeRows fluence(this->Kernels, result.fluence, this->Size, this->Task.light.channels, "fluence");
  const WholeRows direction(this->Kernels, result.meanDirection, this->Size, 3, "mean directions");
  const WholeRows chosen(this->Kernels, result.mipLevel, this->Size, 1, "levels");

  // If the estimator does not use a pyramid, another one is passed in its place; the kernel does not read it.
  const LightPyramid& light = this->Pyramids.front();
  const LightPyramid& heavy = this->Pyramids.back();
  const LightPyramid& photons = this->Pyramids[std::min<std::size_t>(1, this->Pyramids.size() - 1)];
  const Estimator estimator = this->Task.settings.estimator;
  const cl_int kind = estimator == Estimator::Published ? ByPublished
    : estimator == Estimator::ConstantRadius            ? ByConstantRadius
                                                        : ByNearestPhotons;
  cl::Kernel choose = this->Kernels.Kernel("choose_level", kernel_source::LevelReconstruction,
    Define("CHANNELS", this->Task.light.channels) + Define("DIRECTIONS", this->Task.directions));
  With(choose, light.Values(), light.Levels(), photons.Values(), heavy.Values(), photons.Levels(), kind,
    cl_int(this->Task.top), cl_float(kind == ByPublished ? weightStep : this->Task.settings.nearest), fluence.Handle(),
    direction.Handle(), chosen.Handle(), VoxelLayout(this->Size, this->Kernels.Width()));
  this->InParts(choose);
  fluence.Fetch();
  chosen.Fetch();
  direction.Fetch();
}

/// Computes the levels of all pyramids above the shared level, the coarsest one that a rank computes from its own box.
/// Collective.
/// @param passes  no value on ranks without voxels
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
