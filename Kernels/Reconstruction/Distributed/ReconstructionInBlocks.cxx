#include "Reconstruction/Distributed/ReconstructionInBlocks.h"

#include "Device/Clock.h"
#include "Device/Errors.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/SharedMedium.h"
#include "Medium/Medium.h"
#include "Numerics/NumberText.h"
#include "Reconstruction/ConservativePasses.h"
#include "Reconstruction/Distributed/LevelsInBlocks.h"
#include "Reconstruction/Distributed/PyramidBlocks.h"
#include "Reconstruction/ReconstructionChecks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>

namespace tyndall
{
namespace
{
using Estimator = ReconstructionSettings::Estimator;

/// Levels that each rank makes of its block, and voxels round it that its own depend on by them: per level one cell of
/// the level above for interpolation, four for gains and errors, two for details and what they are made of.
constexpr int OwnLevels = 2;
constexpr int MarginOfPasses = 32;

/// Light of ranks that have it alike.
struct Described
{
  int channels = 1, batches = 2;
  bool directions = false;
  double largest = 0.0;             ///< of batches
  std::array<double, 3> total = {}; ///< of all batches
};

/// @throws InvalidInput where a value means nothing: names the voxel of the whole
void CheckValues(const float* values, int width, const Grid& grid, const Grid& whole, const VoxelBox& own, float low,
  float high, const char* name)
{
  const std::size_t count = grid.VoxelCount() * static_cast<std::size_t>(width);
  const float* const unfit =
    std::find_if_not(values, values + count, [&](float value) { return value >= low && value <= high; });
  if (unfit != values + count)
  {
    std::array<int, 3> voxel = grid.VoxelAt(static_cast<std::size_t>(unfit - values) / static_cast<std::size_t>(width));
    for (int axis = 0; axis < 3; ++axis)
    {
      voxel[axis] += own.first[axis];
    }
    throw InvalidInput(std::string(name) + " is " + Text("%g", *unfit) + " in voxel " +
      VoxelName(whole, whole.IndexOf(voxel)) + " (the first such voxel); it must be finite and " +
      (low < 0.0f ? "no longer than 1." : "not negative.") + " Clean the light, or march the photons anew.");
  }
}

/// One rank's part of a reconstruction.
class BlockReconstruction
{
public:
  BlockReconstruction(Device& device, Communicator& communicator, const BlockPartition& partition,
    const ReconstructionSettings& settings, const Monitor& monitor)
    : TheDevice(device)
    , Comm(communicator)
    , Partition(partition)
    , Settings(settings)
    , TheMonitor(monitor)
    , Levels(LevelsOf(partition.whole, settings.levels))
    , Shared(std::min(OwnLevels, this->Levels))
    , Own(partition.blocks[static_cast<std::size_t>(communicator.Rank())])
    , Has(this->Own.VoxelCount() > 0)
    , Blocks(partition, this->Shared, MarginOfPasses, 1 << this->Shared)
  {
  }

  /// @param batches  [voxel][batch][channel] of the own block
  ReconstructedLight Run(
    const Described& what, const std::vector<float>& batches, const std::vector<float>& directions);

private:
  struct Local;
  struct Above;

  const VoxelBox& Box() const { return this->Blocks.Around(this->Comm.Rank()); }

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  const ReconstructionSettings& Settings;
  const Monitor& TheMonitor;
  const int Levels;
  const int Shared; ///< the lowest level that each rank has of all
  const VoxelBox Own;
  const bool Has; ///< voxels
  const PyramidBlocks Blocks;
};

/// Levels of the block and its margin, up to the shared one.
struct BlockReconstruction::Local
{
  Local(const BlockReconstruction& block, const Described& what, std::vector<float>&& batches,
    std::vector<float>&& directions)
    : values(std::move(batches))
    , vectors(std::move(directions))
    , light(this->LightOf(block, what))
    , result(MakeRoom(this->light, true))
    , fluence(block.TheDevice, this->values.data(), this->values.size(), "fluence")
    , direction(block.TheDevice, this->vectors.data(), this->vectors.size(), "mean directions")
    , task{ block.TheDevice, this->light, block.Settings, block.TheMonitor, this->fluence, this->direction,
      { std::nullopt, static_cast<float>(what.largest), what.total }, block.Shared }
    , passes(this->task, this->result)
  {
  }
  NoisyLight LightOf(const BlockReconstruction& block, const Described& what) const
  {
    NoisyLight of;
    of.grid = block.Blocks.GridOf(block.Box().size);
    of.channels = what.channels;
    of.batches = what.batches;
    of.batchFluence = this->values.data();
    of.meanDirection = what.directions ? this->vectors.data() : nullptr;
    return of;
  }

  const std::vector<float> values, vectors;
  const NoisyLight light;
  ReconstructedLight result;
  const HostMappedBuffer<float> fluence, direction;
  const Reconstruction task;
  ConservativePasses passes;
};

/// Levels of all of the grid, from the shared one on.
struct BlockReconstruction::Above
{
  Above(const BlockReconstruction& block, const Described& what)
    : light(this->LightOf(block, what))
    , fluence(block.TheDevice, static_cast<const float*>(nullptr), 0, "fluence")
    , direction(block.TheDevice, static_cast<const float*>(nullptr), 0, "mean directions")
    , task{ block.TheDevice, this->light, block.Settings, block.TheMonitor, this->fluence, this->direction, {},
      block.Levels }
    , passes(this->task, this->result, block.Shared)
  {
  }
  NoisyLight LightOf(const BlockReconstruction& block, const Described& what) const
  {
    NoisyLight of;
    of.grid = block.Partition.whole;
    of.channels = what.channels;
    of.batches = what.batches;
    of.meanDirection = what.directions ? &this->there : nullptr;
    return of;
  }

  const float there = 0.0f;
  const NoisyLight light;
  ReconstructedLight result; ///< of no voxels
  const HostMappedBuffer<float> fluence, direction;
  const Reconstruction task;
  ConservativePasses passes;
};

ReconstructedLight BlockReconstruction::Run(
  const Described& what, const std::vector<float>& batches, const std::vector<float>& directions)
{
  const int width = what.batches * what.channels;
  std::vector<float> around = ValuesInBox(this->Comm, this->Partition, this->Blocks.around, batches, width);
  std::vector<float> vectors = what.directions
    ? ValuesInBox(this->Comm, this->Partition, this->Blocks.around, directions, 3)
    : std::vector<float>();
  const VoxelBox all = { {}, this->Blocks.SharedSize() }, cells = this->Blocks.CellsIn(this->Box());
  std::unique_ptr<Local> local;
  std::vector<float> known;
  this->Comm.Collective([&] {
    if (this->Has)
    {
      local = std::make_unique<Local>(*this, what, std::move(around), std::move(vectors));
      local->passes.Build();
      known = local->passes.LightOf(this->Shared).Read();
    }
  });
  known = this->Blocks.Gather(this->Comm, known, what.batches + what.channels + (what.directions ? 3 : 0));
  std::array<double, 3> total = {};
  this->Comm.Collective([&] {
    if (this->Has)
    {
      Above above(*this, what);
      above.passes.LightOf(this->Shared).Write(known);
      above.passes.Build();
      above.passes.Begin();
      above.passes.Refine(this->Levels - 1, this->Shared);
      LightRows& results = local->passes.ResultsOf(this->Shared);
      results.Write(PartOf(above.passes.ResultsOf(this->Shared).Read(), all, cells, results.Fields()));
      local->passes.Refine(this->Shared - 1, 0);
      local->passes.Totals();
      const std::vector<float> own = PartOf(local->result.fluence, this->Box(), this->Own, what.channels);
      for (std::size_t i = 0; i < own.size(); ++i)
      {
        total[i % static_cast<std::size_t>(what.channels)] += own[i];
      }
    }
  });
  const std::vector<double> sum = this->Comm.Sum({ total[0], total[1], total[2] });
  ReconstructedLight result;
  this->Comm.Collective([&] {
    if (this->Has)
    {
      ReconstructedLight& made = local->result;
      local->passes.Finish(local->task.Conserve({ sum[0], sum[1], sum[2] }, made));
      const auto keep = [&](const std::vector<float>& values, int components) {
        return values.empty() ? values : PartOf(values, this->Box(), this->Own, components);
      };
      result.fluence = keep(made.fluence, what.channels);
      result.fluenceError = keep(made.fluenceError, what.channels);
      result.mipLevel = keep(made.mipLevel, 1);
      result.meanDirection = keep(made.meanDirection, 3);
      result.bias = made.bias;
    }
  });
  result.bias = -this->Comm.Largest({ this->Has ? -result.bias : -std::numeric_limits<double>::infinity() })[0];
  return result;
}

/// What the light is, the same on all ranks.
Described DescribedBy(Communicator& communicator, const NoisyLight& light, bool has)
{
  RequireSame(communicator, "channels, batches and directions of light", has,
    { 1.0 * light.channels, 1.0 * light.batches, light.meanDirection ? 1.0 : 0.0 });
  const std::vector<double> ofAll = communicator.Largest(
    { has ? 1.0 * light.channels : 0.0, has ? 1.0 * light.batches : 0.0, has && light.meanDirection ? 1.0 : 0.0 });
  Described what;
  what.channels = static_cast<int>(ofAll[0]);
  what.batches = static_cast<int>(ofAll[1]);
  what.directions = ofAll[2] > 0.0;
  return what;
}

/// Whether light of three channels is of one colour on all ranks: OneColour of the whole.
bool OneColourOnAll(Communicator& communicator, const std::vector<float>& batches)
{
  constexpr float part = 1e-4f;
  const auto sum = [](const float* rgb) { return rgb[0] + rgb[1] + rgb[2]; };
  const float* brightest = nullptr;
  for (std::size_t i = 0; i < batches.size(); i += 3)
  {
    brightest = !brightest || sum(&batches[i]) > sum(brightest) ? &batches[i] : brightest;
  }
  const double own = brightest ? sum(brightest) : -1.0;
  const double most = communicator.Largest({ own })[0];
  const bool first = brightest && own == most;
  const double rank = -communicator.Largest({ first ? -1.0 * communicator.Rank() : -1.0 * communicator.Ranks() })[0];
  const bool mine = first && rank == communicator.Rank();
  const std::vector<double> colour = communicator.Sum(
    { mine ? brightest[0] / most : 0.0, mine ? brightest[1] / most : 0.0, mine ? brightest[2] / most : 0.0 });
  bool one = true;
  for (std::size_t i = 0; i < batches.size() && most > 0.0 && one; ++i)
  {
    const float of = sum(&batches[i / 3 * 3]);
    one = std::abs(batches[i] - of * static_cast<float>(colour[i % 3])) <= part * of;
  }
  return communicator.Largest({ one ? 0.0 : 1.0 })[0] == 0.0;
}

void FindTotals(Communicator& communicator, const std::vector<float>& batches, Described& what)
{
  std::array<double, 3> total = {};
  float largest = 0.0f;
  for (std::size_t i = 0; i < batches.size(); ++i)
  {
    total[i % static_cast<std::size_t>(what.channels)] += batches[i];
    largest = std::max(largest, batches[i]);
  }
  const std::vector<double> sum = communicator.Sum({ total[0], total[1], total[2] });
  std::copy(sum.begin(), sum.end(), what.total.begin());
  what.largest = communicator.Largest({ largest })[0];
}

/// What a rank can tell of its own light.
void CheckBlock(const NoisyLight& light, const Grid& whole, const VoxelBox& own, Estimator estimator)
{
  constexpr float Most = std::numeric_limits<float>::max(), LongestDirection = 1.001f;
  CheckPresence(light, estimator);
  const auto check = [&](const float* values, int width, bool needed, const char* name, float low, float high) {
    if (values && needed)
    {
      CheckValues(values, width, light.grid, whole, own, low, high, name);
    }
  };
  const bool conservative = estimator == Estimator::Conservative;
  check(light.batchFluence, light.batches * light.channels, conservative, "fluence_batches", 0.0f, Most);
  check(light.fluence, light.channels, !conservative, "fluence", 0.0f, Most);
  check(light.meanDirection, 3, true, "mean_direction", -LongestDirection, LongestDirection);
  check(light.photonCount, 1, NeedsCounts(estimator), "photon_count", 0.0f, Most);
  check(light.photonWeight, 1, NeedsWeights(estimator), "photon_weight", 0.0f, Most);
}

/// By the conservative estimator: channels of several colours each by itself, too.
ReconstructedLight ReconstructBatches(
  BlockReconstruction& block, Communicator& communicator, const NoisyLight& light, Described& what, std::size_t voxels)
{
  const std::size_t width = static_cast<std::size_t>(what.batches) * static_cast<std::size_t>(what.channels);
  const std::vector<float> batches(light.batchFluence, light.batchFluence + voxels * width);
  const std::vector<float> directions(light.meanDirection, light.meanDirection + (what.directions ? 3 * voxels : 0));
  FindTotals(communicator, batches, what);
  ReconstructedLight result = block.Run(what, batches, directions);
  if (what.channels == 1 || OneColourOnAll(communicator, batches))
  {
    return result;
  }
  Described grey = what;
  grey.channels = 1;
  grey.directions = false;
  double before = 0.0, after = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
  {
    std::vector<float> channel(batches.size() / 3);
    for (std::size_t i = 0; i < channel.size(); ++i)
    {
      channel[i] = batches[3 * i + c];
    }
    FindTotals(communicator, channel, grey);
    const ReconstructedLight one = block.Run(grey, channel, {});
    before += grey.total[0];
    after += grey.total[0] * (1.0 + one.bias);
    for (std::size_t i = 0; i < voxels; ++i)
    {
      result.fluence[3 * i + c] = one.fluence[i];
      result.fluenceError[3 * i + c] = one.fluenceError[i];
    }
  }
  result.bias = before > 0.0 ? after / before - 1.0 : 0.0;
  return result;
}
}

ReconstructedLight ReconstructInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const NoisyLight& light, const ReconstructionSettings& settings, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const VoxelBox& own = partition.blocks[static_cast<std::size_t>(communicator.Rank())];
  const bool has = own.VoxelCount() > 0;
  communicator.Collective([&] {
    partition.Check();
    Check(settings);
    if (has)
    {
      CheckBlock(light, partition.whole, own, settings.estimator);
    }
    Report(monitor, 0.0);
  });
  RequireSame(communicator, "settings", true,
    { 1.0 * static_cast<int>(settings.estimator), 1.0 * settings.levels, settings.weightStep, 1.0 * settings.level,
      1.0 * settings.nearest, 1.0 * settings.conserve });
  Described what = DescribedBy(communicator, light, has);
  ReconstructedLight result;
  if (settings.estimator == Estimator::Conservative)
  {
    BlockReconstruction block(device, communicator, partition, settings, monitor);
    result = ReconstructBatches(block, communicator, light, what, has ? light.grid.VoxelCount() : 0);
  }
  else
  {
    result =
      LevelsInBlocks(device, communicator, partition, settings, monitor).Run(light, what.channels, what.directions);
  }
  NoisyLight described = light;
  const float there = 0.0f;
  described.channels = what.channels;
  described.meanDirection = what.directions ? &there : nullptr;
  SayWhatIsLeftOut(described, result);
  result.device = device.Name();
  result.seconds = ClockSeconds() - start;
  return result;
}
}
