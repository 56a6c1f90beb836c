// Light that is spread over ranks, smoothed by blocks, against the whole on one.
#include "DeviceTest.h"
#include "ReconstructionScene.h"

#include "Distribution/BoxExchange.h"
#include "Distribution/RanksInThreads.h"
#include "Reconstruction/Distributed/ReconstructionInBlocks.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace tyndall;
using testing::HasSubstr;

namespace
{
/// A lit edge, a gradient and a dark corner, with noise.
ReconstructionScene Scene(std::array<int, 3> size, int channels = 1, int batches = 2, bool oneColour = false)
{
  ReconstructionScene scene(size, channels, batches);
  scene.Light(
    [&](std::size_t value) {
      const std::array<int, 3> at = scene.grid.VoxelAt(value / static_cast<std::size_t>(channels));
      const double colour =
        oneColour ? 1.0 : 1.0 + 0.5 * static_cast<double>(value % static_cast<std::size_t>(channels));
      const double edge =
        at[0] + at[2] > size[0] / 2 + at[1] ? 5.0 * (channels == 3 && !oneColour ? colour : 1.0) : 1.0;
      return (at[2] < 3 ? 0.0 : edge + 0.02 * at[1]) * colour;
    },
    0.4);
  return scene;
}

class ReconstructionInBlocksTest : public DeviceTest
{
protected:
  void ExpectTheWhole(const ReconstructionScene& scene, const BlockPartition& partition, bool directions = true,
    const ReconstructionSettings& settings = {})
  {
    NoisyLight light = LightOf(scene, scene.grid, scene.batchFluence, directions ? &scene.direction : nullptr);
    const ReconstructedLight whole = Reconstruct(this->GetDevice(), light, settings);
    const double most = *std::max_element(whole.fluence.begin(), whole.fluence.end());
    const VoxelBox all = { {}, scene.grid.size };
    const int width = scene.channels * scene.batches;
    RunInThreads(static_cast<int>(partition.blocks.size()), [&](Communicator& communicator) {
      const VoxelBox& own = partition.blocks[static_cast<std::size_t>(communicator.Rank())];
      Grid grid = scene.grid;
      grid.size = own.size;
      const std::vector<float> batches = PartOf(scene.batchFluence, all, own, width);
      const std::vector<float> ways = PartOf(scene.direction, all, own, 3);
      const ReconstructedLight found = ReconstructInBlocks(this->GetDevice(), communicator, partition,
        LightOf(scene, grid, batches, directions ? &ways : nullptr), settings);
      const auto expect = [&](const std::vector<float>& here, const std::vector<float>& there, int components,
                            double precision, const char* what) {
        const std::vector<float> wanted = there.empty() ? there : PartOf(there, all, own, components);
        ASSERT_EQ(here.size(), wanted.size()) << what;
        double worst = 0.0;
        for (std::size_t i = 0; i < here.size(); ++i)
        {
          worst = std::max<double>(worst, std::abs(here[i] - wanted[i]));
        }
        EXPECT_LE(worst, precision) << what << " on rank " << communicator.Rank() << " of " << partition.blocks.size();
      };
      expect(found.fluence, whole.fluence, scene.channels, 1e-6 * most, "fluence");
      expect(found.fluenceError, whole.fluenceError, scene.channels, 1e-6 * most, "fluence_error");
      expect(found.mipLevel, whole.mipLevel, 1, 1e-4, "mip_level");
      expect(found.meanDirection, whole.meanDirection, 3, 1e-5, "mean_direction");
      EXPECT_NEAR(found.bias, whole.bias, 1e-6);
      EXPECT_EQ(found.leftOut, whole.leftOut);
    });
  }

  static NoisyLight LightOf(const ReconstructionScene& scene, const Grid& grid, const std::vector<float>& batches,
    const std::vector<float>* directions)
  {
    NoisyLight light;
    light.grid = grid;
    light.channels = scene.channels;
    light.batches = scene.batches;
    light.batchFluence = batches.data();
    light.meanDirection = directions ? directions->data() : nullptr;
    return light;
  }
};

TEST_F(ReconstructionInBlocksTest, IsThatOfTheWhole)
{
  const ReconstructionScene scene = Scene({ 90, 37, 22 });
  for (const int ranks : { 1, 3, 8 })
  {
    this->ExpectTheWhole(scene, BlockPartition::Even(scene.grid, ranks));
  }
}

/// Blocks that end far from each other, so that none has all of the grid within its margin.
TEST_F(ReconstructionInBlocksTest, NeedsNoMoreThanItsMargin)
{
  const ReconstructionScene scene = Scene({ 211, 12, 9 }, 1, 4);
  this->ExpectTheWhole(scene, BlockPartition::Even(scene.grid, 5));
  ReconstructionSettings settings;
  settings.levels = 8;
  this->ExpectTheWhole(scene, BlockPartition::Even(scene.grid, 3), true, settings);
  settings.levels = 1;
  settings.conserve = false;
  this->ExpectTheWhole(scene, BlockPartition::Even(scene.grid, 3), false, settings);
}

TEST_F(ReconstructionInBlocksTest, HasColour)
{
  const ReconstructionScene colours = Scene({ 101, 11, 10 }, 3), one = Scene({ 101, 11, 10 }, 3, 2, true);
  this->ExpectTheWhole(colours, BlockPartition::Even(colours.grid, 3));
  this->ExpectTheWhole(one, BlockPartition::Even(one.grid, 3));
}

TEST_F(ReconstructionInBlocksTest, TakesUnevenAndEmptyBlocksAndSingleVoxels)
{
  const ReconstructionScene scene = Scene({ 83, 6, 5 });
  this->ExpectTheWhole(scene,
    { scene.grid,
      { { { 1, 0, 0 }, { 82, 6, 5 } }, {}, { { 0, 1, 0 }, { 1, 5, 5 } }, { { 0, 0, 1 }, { 1, 1, 4 } },
        { { 0, 0, 0 }, { 1, 1, 1 } } } });
  const ReconstructionScene small = Scene({ 2, 1, 5 });
  this->ExpectTheWhole(small, BlockPartition::Even(small.grid, 4));
}

TEST_F(ReconstructionInBlocksTest, FailsTogether)
{
  ReconstructionScene scene = Scene({ 12, 10, 8 });
  const BlockPartition partition = BlockPartition::Even(scene.grid, 3);
  const VoxelBox all = { {}, scene.grid.size };
  scene.batchFluence[2 * scene.grid.IndexOf({ 11, 3, 2 })] = std::numeric_limits<float>::quiet_NaN();
  const auto said = [&](const ReconstructionSettings& settings, bool unlike) {
    std::vector<std::string> errors(3);
    RunInThreads(3, [&](Communicator& communicator) {
      const auto rank = static_cast<std::size_t>(communicator.Rank());
      Grid grid = scene.grid;
      grid.size = partition.blocks[rank].size;
      const std::vector<float> batches = PartOf(scene.batchFluence, all, partition.blocks[rank], 2);
      const std::vector<float> ways = PartOf(scene.direction, all, partition.blocks[rank], 3);
      try
      {
        ReconstructInBlocks(this->GetDevice(), communicator, partition,
          LightOf(scene, grid, batches, unlike && rank == 1 ? nullptr : &ways), settings);
      }
      catch (const InvalidInput& error)
      {
        errors[rank] = error.what();
      }
    });
    EXPECT_EQ(errors[0], errors[1]);
    EXPECT_EQ(errors[0], errors[2]);
    return errors[0];
  };
  EXPECT_THAT(said({}, false), HasSubstr("(11, 3, 2)"));
  ReconstructionSettings settings;
  settings.estimator = ReconstructionSettings::Estimator::Published;
  EXPECT_THAT(said(settings, false), HasSubstr("There is no fluence"));
  scene.batchFluence[2 * scene.grid.IndexOf({ 11, 3, 2 })] = 1.0f;
  EXPECT_THAT(said({}, true), HasSubstr("disagree about channels"));
}

/// By the estimators that take light from one level, whose choice is that of the whole to the last voxel.
class LevelsInBlocksTest : public DeviceTest
{
protected:
  /// With photons of some weights, more of them where it is bright.
  static ReconstructionScene WithPhotons(std::array<int, 3> size, int channels)
  {
    ReconstructionScene scene = Scene(size, channels);
    std::mt19937 random(4);
    for (std::size_t i = 0; i < scene.grid.VoxelCount(); ++i)
    {
      const double fluence = scene.fluence[i * static_cast<std::size_t>(channels)];
      scene.count[i] = static_cast<float>(std::poisson_distribution<int>(0.3 * fluence + 1e-3)(random));
      scene.weight[i] = scene.count[i] > 0.0f ? 0.5f + 0.01f * static_cast<float>(random() % 100) : 0.0f;
    }
    return scene;
  }

  void ExpectTheWhole(
    const ReconstructionScene& scene, const BlockPartition& partition, const ReconstructionSettings& settings)
  {
    const ReconstructedLight whole = Reconstruct(this->GetDevice(), scene.Seen(), settings);
    const double most = *std::max_element(whole.fluence.begin(), whole.fluence.end());
    RunInThreads(static_cast<int>(partition.blocks.size()), [&](Communicator& communicator) {
      const VoxelBox all = { {}, scene.grid.size },
                     own = partition.blocks[static_cast<std::size_t>(communicator.Rank())];
      ReconstructionScene part(own.size, scene.channels);
      part.fluence = PartOf(scene.fluence, all, own, scene.channels);
      part.direction = PartOf(scene.direction, all, own, 3);
      part.count = PartOf(scene.count, all, own, 1);
      part.weight = PartOf(scene.weight, all, own, 1);
      const ReconstructedLight found =
        ReconstructInBlocks(this->GetDevice(), communicator, partition, part.Seen(), settings);
      EXPECT_EQ(found.mipLevel, PartOf(whole.mipLevel, all, own, 1));
      EXPECT_EQ(found.meanDirection, PartOf(whole.meanDirection, all, own, 3));
      EXPECT_EQ(found.leftOut, whole.leftOut);
      EXPECT_NEAR(found.bias, whole.bias, 1e-6);
      const std::vector<float> fluence = PartOf(whole.fluence, all, own, scene.channels);
      ASSERT_EQ(found.fluence.size(), fluence.size());
      for (std::size_t i = 0; i < fluence.size(); ++i)
      {
        ASSERT_NEAR(found.fluence[i], fluence[i], 1e-6 * most) << i << " of rank " << communicator.Rank();
      }
    });
  }
};

TEST_F(LevelsInBlocksTest, AreThoseOfTheWhole)
{
  using Estimator = ReconstructionSettings::Estimator;
  const ReconstructionScene scene = WithPhotons({ 83, 22, 9 }, 1), colours = WithPhotons({ 37, 12, 10 }, 3);
  const BlockPartition uneven = { scene.grid,
    { { { 1, 0, 0 }, { 82, 22, 9 } }, {}, { { 0, 1, 0 }, { 1, 21, 9 } }, { { 0, 0, 1 }, { 1, 1, 8 } },
      { { 0, 0, 0 }, { 1, 1, 1 } } } };
  for (const Estimator estimator : { Estimator::Published, Estimator::ConstantRadius, Estimator::NearestPhotons })
  {
    SCOPED_TRACE(static_cast<int>(estimator));
    ReconstructionSettings settings = By(estimator);
    settings.level = 4;
    this->ExpectTheWhole(scene, BlockPartition::Even(scene.grid, 3), settings);
    this->ExpectTheWhole(scene, uneven, settings);
    settings.conserve = false;
    settings.level = 1;
    this->ExpectTheWhole(colours, BlockPartition::Even(colours.grid, 2), settings);
  }
}

TEST_F(LevelsInBlocksTest, MayBeNone)
{
  const ReconstructionScene small = WithPhotons({ 2, 1, 5 }, 1);
  this->ExpectTheWhole(
    small, BlockPartition::Even(small.grid, 4), By(ReconstructionSettings::Estimator::NearestPhotons));
}
}
