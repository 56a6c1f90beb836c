// Errors that are estimated of light in a medium that is spread over ranks are those of the whole.

#include "BlocksOfLight.h"

#include "Distribution/BoxExchange.h"
#include "Distribution/CoarseBlocks.h"
#include "LightPropagation/Accuracy/TargetError.h"
#include "LightPropagation/Problem/PropagationQuality.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace blocks_of_light;
using namespace tyndall;

namespace
{
PropagationSolver SolverOn(Device& device)
{
  return [&device](const SceneBlock& block, const PropagationSettings& settings, const Monitor& monitor) {
    return SolveConservative(device, block.domain, block.medium, block.illumination, settings, monitor);
  };
}

LightField EstimatedOfAll(Device& device, const BlockPartition& partition, const RandomMedium& whole,
  const Illumination& shining, const PropagationSettings& settings)
{
  return LightOfAll(
    partition, whole, shining, [&](Communicator& communicator, const Medium& medium, const Illumination& light) {
      return SolveWithErrorEstimate({ Domain(communicator, partition), medium, light }, settings, {}, SolverOn(device));
    });
}

/// Errors are differences of light: they are compared as parts of that.
void ExpectSameErrors(const LightField& found, const LightField& expected, double tolerance = 1e-6)
{
  EXPECT_LT(RelativeRmse(found.fluence, expected.fluence), tolerance);
  ASSERT_EQ(found.fluenceError.size(), expected.fluenceError.size());
  ASSERT_FALSE(expected.fluenceError.empty());
  const double brightest = *std::max_element(expected.fluence.begin(), expected.fluence.end());
  for (std::size_t i = 0; i < found.fluenceError.size(); ++i)
  {
    ASSERT_NEAR(found.fluenceError[i], expected.fluenceError[i], tolerance * brightest) << i;
  }
  EXPECT_NEAR(found.relativeError, expected.relativeError, tolerance);
}

std::vector<BlockPartition> CutsOf(const Grid& grid)
{
  return { BlockPartition::Even(grid, 1), BlockPartition::Even(grid, 3), Uneven(grid) };
}
}

TEST(CoarseBlocks, HaveEachCoarseVoxelOnce)
{
  for (const int x : { 1, 2, 3, 5, 8, 13 })
  {
    const Grid grid = { { x, 7, 4 } };
    std::vector<BlockPartition> cuts = CutsOf(grid);
    cuts.push_back(VoxelByVoxel(grid));
    for (const BlockPartition& partition : cuts)
    {
      SingleRank one;
      const CoarseBlocks blocks(one, partition);
      EXPECT_NO_THROW(blocks.Coarse().Check()) << x;
      EXPECT_EQ(blocks.Coarse().whole.size, Coarsening(grid).Coarse().size);
    }
  }
}

/// Also where they end amid coarse voxels.
TEST(CoarseBlocks, AverageAsTheWholeDoes)
{
  const Grid grid = { { 7, 9, 10 } };
  std::vector<float> values(2 * grid.VoxelCount());
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = std::sin(static_cast<float>(i * i % 1013));
  }
  const Coarsening whole(grid);
  const std::vector<float> expected = whole.Average(values.data(), 2);
  const VoxelBox all = { {}, grid.size }, coarse = { {}, whole.Coarse().size };
  for (const BlockPartition& partition :
    { BlockPartition::Even(grid, 3), BlockPartition::Even(grid, 40), Uneven(grid) })
  {
    RunInThreads(static_cast<int>(partition.blocks.size()), [&](Communicator& communicator) {
      const VoxelBox& own = partition.blocks[communicator.Rank()];
      const CoarseBlocks blocks(communicator, partition);
      const std::vector<float> found = blocks.Average(tyndall::PartOf(values, all, own, 2), 2);
      EXPECT_EQ(found, tyndall::PartOf(expected, coarse, blocks.Coarse().blocks[communicator.Rank()], 2));
      const std::vector<float> seen = blocks.SeenOf(found, 2);
      for (std::size_t i = 0; i < own.VoxelCount(); ++i)
      {
        std::array<int, 3> at = partition.OwnGrid(communicator.Rank()).VoxelAt(i);
        for (int axis = 0; axis < 3; ++axis)
        {
          at[axis] += own.first[axis];
        }
        ASSERT_EQ(seen[2 * blocks.Seen().Parent(i)], expected[2 * whole.Parent(grid.IndexOf(at))]);
      }
    });
  }
}

class ErrorInBlocks : public DeviceTest
{
protected:
  void ExpectTheErrorsOfTheWhole(
    const RandomMedium& whole, const Illumination& shining, const PropagationSettings& settings)
  {
    const LightField expected = SolveWithErrorEstimate(
      { Domain(whole.medium.grid), whole.medium, shining }, settings, {}, SolverOn(this->GetDevice()));
    EXPECT_GT(expected.relativeError, 1e-3);
    for (const BlockPartition& partition : CutsOf(whole.medium.grid))
    {
      SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
      ExpectSameErrors(EstimatedOfAll(this->GetDevice(), partition, whole, shining, settings), expected);
    }
  }
};

TEST_F(ErrorInBlocks, IsThatOfTheWhole)
{
  RandomMedium whole(Grid{ { 9, 7, 8 }, { 1.0, 0.7, 1.2 } }, 3, 0.6f, 7);
  whole.Emit(0.1f);
  PropagationSettings settings = SettingsOf(3);
  settings.uncollidedDirections = 25;
  this->ExpectTheErrorsOfTheWhole(whole, LitFromOutside(), settings);
}

/// Cosines by voxel, weighted by what is scattered, and light that another solver found.
TEST_F(ErrorInBlocks, IsThatOfTheWholeWithCosinesAndLightByVoxel)
{
  RandomMedium whole(Grid{ { 10, 7, 9 } }, 1, 0.6f, 7);
  std::vector<float> g, fluence, directions;
  for (std::size_t i = 0; i < whole.medium.grid.VoxelCount(); ++i)
  {
    g.push_back(0.5f + 0.3f * std::sin(static_cast<float>(i)));
    fluence.push_back(1.0f + 0.5f * std::cos(static_cast<float>(2 * i)));
    directions.insert(directions.end(), { 0.6f, 0.1f, 0.3f * std::sin(static_cast<float>(3 * i)) });
  }
  whole.medium.phase = PhaseOfMedium(PhaseFunction::HenyeyGreenstein(0.5), { g.data(), 1 });
  Illumination shining;
  shining.uncollided.fluence = { fluence.data(), 1 };
  shining.uncollided.meanDirection = { directions.data(), 3 };
  this->ExpectTheErrorsOfTheWhole(whole, shining, SettingsOf(4));
}

/// Most ranks have no coarse voxel.
TEST_F(ErrorInBlocks, MayBeOfBlocksOfOneVoxel)
{
  RandomMedium whole(Grid{ { 3, 3, 2 } }, 1, 0.6f, 7);
  const LightField expected = SolveWithErrorEstimate(
    { Domain(whole.medium.grid), whole.medium, LitFromOutside() }, SettingsOf(3), {}, SolverOn(this->GetDevice()));
  ExpectSameErrors(
    EstimatedOfAll(this->GetDevice(), VoxelByVoxel(whole.medium.grid), whole, LitFromOutside(), SettingsOf(3)),
    expected);
}

/// Thick voxels, accelerated; with finer directions of light from outside, which the coarse ones cannot have.
TEST_F(ErrorInBlocks, DoesNotDependOnTheNumberOfRanks)
{
  for (const float densest : { 8.0f, 0.8f })
  {
    RandomMedium whole(Grid{ { 12, 11, 13 } }, 1, densest, 4);
    Share(whole, 0.01f, 0.99f);
    Illumination shining;
    shining.faces[2] = { 1.0, 1.0, 1.0 };
    PropagationSettings settings = SettingsOf(0);
    settings.acceleration = PropagationAcceleration::Automatic;
    settings.source = PropagationSource::Automatic;
    settings.uncollidedDirections = -1;
    const LightField one =
      EstimatedOfAll(this->GetDevice(), BlockPartition::Even(whole.medium.grid, 1), whole, shining, settings);
    const LightField ofWhole = SolveWithErrorEstimate(
      { Domain(whole.medium.grid), whole.medium, shining }, settings, {}, SolverOn(this->GetDevice()));
    EXPECT_LT(one.relativeError, 2.0 * ofWhole.relativeError);
    EXPECT_GT(one.relativeError, 0.5 * ofWhole.relativeError);
    for (const BlockPartition& partition : { BlockPartition::Even(whole.medium.grid, 3), Uneven(whole.medium.grid) })
    {
      ExpectSameErrors(EstimatedOfAll(this->GetDevice(), partition, whole, shining, settings), one);
    }
  }
}

/// The same directions, tolerance and voxels are chosen, and the same light found.
namespace
{
/// Of all of the box's faces, on each rank.
void ExpectSameCells(const LightField& found, const LightField& expected)
{
  ASSERT_EQ(found.facePower.size(), expected.facePower.size());
  ASSERT_FALSE(found.facePower.empty());
  const float largest = *std::max_element(expected.facePower.begin(), expected.facePower.end());
  for (std::size_t i = 0; i < found.facePower.size(); ++i)
  {
    ASSERT_NEAR(found.facePower[i], expected.facePower[i], 1e-5 * largest) << "cell " << i;
  }
}
}

TEST_F(ErrorInBlocks, IsBroughtToATargetAsThatOfTheWhole)
{
  RandomMedium whole(Grid{ { 8, 7, 9 } }, 1, 0.5f, 7);
  Illumination shining;
  shining.faces[2] = { 1.0, 1.0, 1.0 };
  PropagationSettings settings;
  settings.acceleration = PropagationAcceleration::None;
  settings.source = PropagationSource::Constant;
  settings.emissionError = 0.0;
  settings.facePower = true;
  for (const double target : { 0.2, 0.008 })
  {
    const TargetLight expected = SolveToTargetError(
      { Domain(whole.medium.grid), whole.medium, shining }, settings, target, {}, SolverOn(this->GetDevice()));
    for (const BlockPartition& partition : { BlockPartition::Even(whole.medium.grid, 3), Uneven(whole.medium.grid) })
    {
      SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks, " + std::to_string(target));
      const LightField found = LightOfAll(
        partition, whole, shining, [&](Communicator& communicator, const Medium& medium, const Illumination& light) {
          const TargetLight own = SolveToTargetError(
            { Domain(communicator, partition), medium, light }, settings, target, {}, SolverOn(this->GetDevice()));
          EXPECT_EQ(own.divided, expected.divided);
          EXPECT_EQ(own.solves, expected.solves);
          EXPECT_EQ(Words(own.settings), Words(expected.settings));
          EXPECT_EQ(own.met, expected.met);
          ExpectSameCells(own.light, expected.light);
          return own.light;
        });
      ExpectSameErrors(found, expected.light);
    }
    EXPECT_EQ(expected.divided, target < 0.1);
  }
}
