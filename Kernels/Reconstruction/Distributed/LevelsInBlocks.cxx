#include "Reconstruction/Distributed/LevelsInBlocks.h"

#include "Distribution/BoxExchange.h"
#include "Reconstruction/Distributed/PyramidBlocks.h"
#include "Reconstruction/LevelReconstruction.h"
#include "Reconstruction/LightRows.h"
#include "Reconstruction/ReconstructionChecks.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// Levels that each rank makes of its block, and voxels round it that its own depend on by them: light lies between the
/// cells of a level, one more to either side, and these are of two cells below and four in all. Vectors of voxels begin
/// at multiples of eight.
constexpr int LevelsOfBlock = 2;
constexpr int MarginOfLevels = 16;
constexpr int Edge = 8;

/// Totals of `channels` side by side.
std::array<double, 3> TotalsOf(const float* values, std::size_t count, int channels)
{
  std::array<double, 3> total = {};
  for (std::size_t i = 0; i < count; ++i)
  {
    total[i % static_cast<std::size_t>(channels)] += values[i];
  }
  return total;
}
}

/// Arrays of the block and its margin.
struct LevelsInBlocks::Around
{
  std::vector<float> fluence, directions, counts, weights;
};

/// A rank's block, its margin and their pyramids.
struct LevelsInBlocks::Local
{
  Local(const LevelsInBlocks& all, const PyramidBlocks& blocks, Around&& arrays, int channels, bool directions)
    : box(blocks.Around(all.Comm.Rank()))
    , around(std::move(arrays))
    , light(this->LightOf(blocks, channels, directions))
    , result(MakeRoom(this->light, false))
    , fluence(all.TheDevice, std::as_const(this->around.fluence).data(), this->around.fluence.size(), "fluence")
    , direction(
        all.TheDevice, std::as_const(this->around.directions).data(), this->around.directions.size(), "mean directions")
    , task{ all.TheDevice, this->light, all.Settings, all.TheMonitor, this->fluence, this->direction, {}, all.Levels }
    , photons(this->task)
    , passes(this->task, this->photons, this->result, RowWidth(all.TheDevice, all.Partition.whole),
        { all.Partition.whole.size, this->box.first, blocks.shared })
  {
  }
  NoisyLight LightOf(const PyramidBlocks& blocks, int channels, bool directions) const
  {
    NoisyLight of;
    of.grid = blocks.GridOf(this->box.size);
    of.channels = channels;
    of.fluence = this->around.fluence.data();
    of.meanDirection = directions ? this->around.directions.data() : nullptr;
    of.photonCount = this->around.counts.data();
    of.photonWeight = this->around.weights.data();
    return of;
  }

  const VoxelBox box;
  const Around around;
  const NoisyLight light;
  ReconstructedLight result;
  const HostMappedBuffer<float> fluence, direction;
  const Reconstruction task;
  const PhotonsOfVoxels photons;
  LevelPasses passes;
};

LevelsInBlocks::LevelsInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const ReconstructionSettings& settings, const Monitor& monitor)
  : TheDevice(device)
  , Comm(communicator)
  , Partition(partition)
  , Settings(settings)
  , TheMonitor(monitor)
  , Levels(LevelsOf(partition.whole, settings.levels))
  , Blocks(partition, std::min(LevelsOfBlock, TopLevelOf(settings, this->Levels)), MarginOfLevels, Edge)
{
}

LevelsInBlocks::Around LevelsInBlocks::Gather(const NoisyLight& light, int channels, bool directions) const
{
  const std::size_t voxels = this->Partition.blocks[static_cast<std::size_t>(this->Comm.Rank())].VoxelCount();
  const auto gathered = [&](const float* values, int components, bool needed) {
    const std::vector<float> own =
      voxels > 0 && needed ? std::vector<float>(values, values + voxels * components) : std::vector<float>();
    return needed ? ValuesInBox(this->Comm, this->Partition, this->Blocks.around, own, components) : own;
  };
  Around around;
  around.fluence = gathered(light.fluence, channels, true);
  around.directions = gathered(light.meanDirection, 3, directions);
  around.counts = gathered(light.photonCount, 1, NeedsCounts(this->Settings.estimator));
  around.weights = gathered(light.photonWeight, 1, NeedsWeights(this->Settings.estimator));
  return around;
}

/// That of the whole.
double LevelsInBlocks::WeightStep(const NoisyLight& light) const
{
  WeightsOfVoxels weights;
  const std::size_t voxels = this->Partition.blocks[static_cast<std::size_t>(this->Comm.Rank())].VoxelCount();
  if (NeedsWeights(this->Settings.estimator) && voxels > 0)
  {
    weights = WeightsOfVoxels(light.photonWeight, voxels);
  }
  const std::vector<double> all = this->Comm.Sum({ weights.total, weights.lit });
  weights.total = all[0];
  weights.lit = all[1];
  return WeightStepOf(this->Settings, weights);
}

/// Levels above those of blocks.
void LevelsInBlocks::CompletePyramids(Local* local, int channels, bool directions)
{
  if (TopLevelOf(this->Settings, this->Levels) <= this->Blocks.shared)
  {
    return;
  }
  const std::vector<int> fields = FieldsOfPyramids(this->Settings.estimator, channels, directions);
  for (std::size_t pyramid = 0; pyramid < fields.size(); ++pyramid)
  {
    std::vector<float> cells;
    this->Comm.Collective([&] { cells = local ? local->passes.Shared(pyramid) : cells; });
    cells = this->Blocks.Gather(this->Comm, cells, fields[pyramid]);
    this->Comm.Collective([&] {
      if (local)
      {
        local->passes.BuildAbove(pyramid, cells);
      }
    });
  }
}

/// Of the rank's own voxels, and scaled as the settings say.
ReconstructedLight LevelsInBlocks::Kept(Local* local, const NoisyLight& light, int channels)
{
  const VoxelBox& own = this->Partition.blocks[static_cast<std::size_t>(this->Comm.Rank())];
  ReconstructedLight kept;
  std::array<double, 3> was = {}, is = {};
  this->Comm.Collective([&] {
    if (local)
    {
      const auto keep = [&](const std::vector<float>& values, int components) {
        return values.empty() ? values : PartOf(values, local->box, own, components);
      };
      kept.fluence = keep(local->result.fluence, channels);
      kept.mipLevel = keep(local->result.mipLevel, 1);
      kept.meanDirection = keep(local->result.meanDirection, 3);
      was = TotalsOf(light.fluence, kept.fluence.size(), channels);
      is = TotalsOf(kept.fluence.data(), kept.fluence.size(), channels);
    }
  });
  const std::vector<double> sums = this->Comm.Sum({ was[0], was[1], was[2], is[0], is[1], is[2] });
  const HostMappedBuffer<float> none(this->TheDevice, static_cast<const float*>(nullptr), 0, "nothing");
  NoisyLight described;
  described.channels = channels;
  const Reconstruction task = { this->TheDevice, described, this->Settings, this->TheMonitor, none, none,
    { std::nullopt, 0.0f, { sums[0], sums[1], sums[2] } }, this->Levels };
  const std::array<float, 3> factors = task.Conserve({ sums[3], sums[4], sums[5] }, kept);
  for (std::size_t i = 0; i < kept.fluence.size(); ++i)
  {
    kept.fluence[i] *= factors[i % static_cast<std::size_t>(channels)];
  }
  return kept;
}

ReconstructedLight LevelsInBlocks::Run(const NoisyLight& light, int channels, bool directions)
{
  Around around = this->Gather(light, channels, directions);
  const double step = this->WeightStep(light);
  std::unique_ptr<Local> local;
  this->Comm.Collective([&] {
    if (!around.fluence.empty())
    {
      local = std::make_unique<Local>(*this, this->Blocks, std::move(around), channels, directions);
      local->passes.Build();
    }
  });
  this->CompletePyramids(local.get(), channels, directions);
  this->Comm.Collective([&] {
    if (local)
    {
      local->passes.Choose(step);
    }
  });
  return this->Kept(local.get(), light, channels);
}
}
