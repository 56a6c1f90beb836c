// The last light as the first guess of a medium that is spread over ranks, each of which keeps that of its own block:
// the light of the whole that begins from its own, by as many orders (numerics.md, section 6.4).

#include "BlocksOfLight.h"

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using namespace blocks_of_light;
using namespace tyndall;

namespace
{
/// Over the largest value.
double LargestDifference(const std::vector<float>& found, const std::vector<float>& expected)
{
  double largest = 0.0, difference = found.size() == expected.size() ? 0.0 : HUGE_VAL;
  for (std::size_t i = 0; i < expected.size() && i < found.size(); ++i)
  {
    largest = std::max<double>(largest, std::abs(expected[i]));
    difference = std::max<double>(difference, std::abs(found[i] - expected[i]));
  }
  return largest > 0.0 ? difference / largest : difference;
}

/// Slices along x: the first a voxel wide, the second without any.
BlockPartition UnevenSlices(const Grid& grid)
{
  const std::array<int, 3>& n = grid.size;
  return { grid, { { { 0, 0, 0 }, { 1, n[1], n[2] } }, {}, { { 1, 0, 0 }, { n[0] - 1, n[1], n[2] } } } };
}

/// A scene and what becomes of it.
struct Change
{
  RandomMedium before, after;
  Illumination shining, next;
  PropagationSettings settings;

  /// Nothing, yet.
  Change(const Grid& grid, int components, float densest, float scattered, const PropagationSettings& how)
    : before(grid, components, densest, 5)
    , after(grid, components, densest, 5)
    , shining(LitFromOutside())
    , next(LitFromOutside())
    , settings(how)
  {
    for (RandomMedium* medium : { &this->before, &this->after })
    {
      Share(*medium, 1.0f - scattered, scattered);
      medium->Emit(0.3f);
    }
  }
  void TurnLamp() { this->next.lights[0].direction = { 0.35, -0.45, -0.9 }; }
  void DarkenTo(float scattered) { Share(this->after, 1.0f - scattered, scattered); }
};

PropagationSettings ToTolerance(double tolerance)
{
  PropagationSettings settings = SettingsOf(0);
  settings.tolerance = tolerance;
  return settings;
}
}

class WarmStartsInBlocks : public DeviceTest
{
protected:
  using Kept = std::vector<KeptLight>; ///< by rank

  LightField OfBlocks(const BlockPartition& partition, const RandomMedium& whole, const Illumination& shining,
    const PropagationSettings& settings, Kept* kept)
  {
    return LightOfAll(
      partition, whole, shining, [&](Communicator& communicator, const Medium& medium, const Illumination& light) {
        return SolveConservative(GetDevice(), Domain(communicator, partition), medium, light, settings, {},
          kept ? &kept->at(communicator.Rank()) : nullptr);
      });
  }
  LightField AfterInBlocks(const BlockPartition& partition, const Change& change)
  {
    Kept kept(partition.blocks.size());
    const LightField first = OfBlocks(partition, change.before, change.shining, change.settings, &kept);
    EXPECT_THAT(first.leftOut, testing::Contains(testing::HasSubstr("there is none")));
    EXPECT_THAT(first.sweepsSaved, testing::Each(0));
    return OfBlocks(partition, change.after, change.next, change.settings, &kept);
  }

  /// To 1e-6 of the largest fluence.
  void ExpectTheWarmLightOfTheWhole(
    const Change& change, const std::string& name, const std::vector<BlockPartition>& partitions)
  {
    SCOPED_TRACE(name);
    KeptLight kept;
    SolveConservative(GetDevice(), change.before.medium, change.shining, change.settings, {}, &kept);
    const LightField whole =
      SolveConservative(GetDevice(), change.after.medium, change.next, change.settings, {}, &kept);
    const BlockPartition one = BlockPartition::Even(change.before.medium.grid, 1);
    const LightField cold = OfBlocks(one, change.after, change.next, change.settings, nullptr);
    const LightField alone = AfterInBlocks(one, change);
    std::printf("%-44s %zu -> %zu sweeps (whole %zu), %.2g from the whole\n", name.c_str(), cold.convergence.size(),
      alone.convergence.size(), whole.convergence.size(), LargestDifference(alone.fluence, whole.fluence));
    EXPECT_LT(alone.convergence.size(), cold.convergence.size());
    ExpectSameWarm(alone, whole);
    for (std::size_t i = 0; i < partitions.size(); ++i)
    {
      SCOPED_TRACE("partition " + std::to_string(i));
      ExpectSameWarm(AfterInBlocks(partitions[i], change), whole);
    }
  }
  /// In an open box with a white face, and round an axis: of another solver than maps.
  /// @param settings  of that, whose axes are set
  /// @param whole   of a medium, what shines on it, and kept light
  /// @param blocks  of a partition, a rank and its part, what shines, and kept light
  template <class Settings, class Whole, class Blocks>
  void ExpectTheOrdersOfTheWhole(Change& change, Settings& settings, const std::vector<BlockPartition>& partitions,
    const Whole& whole, const Blocks& blocks)
  {
    change.TurnLamp();
    change.DarkenTo(0.88f);
    const auto ofAll = [&](const BlockPartition& partition, const RandomMedium& all, const Illumination& light,
                         Kept& kept) {
      return LightOfAll(
        partition, all, light, [&](Communicator& communicator, const Medium& medium, const Illumination& shining) {
          return blocks(partition, communicator, medium, shining, &kept[communicator.Rank()]);
        });
    };
    for (const bool around : { false, true })
    {
      SCOPED_TRACE(around ? "periodic" : "open, a white face");
      settings.periodic[0] = around;
      change.shining.faceAlbedo[4] = change.next.faceAlbedo[4] = around ? Rgb{} : Rgb{ 0.7, 0.7, 0.7 };
      KeptLight kept;
      whole(change.before, change.shining, &kept);
      const LightField expected = whole(change.after, change.next, &kept);
      EXPECT_LT(expected.convergence.size(), whole(change.after, change.next, nullptr).convergence.size());
      for (const BlockPartition& partition : partitions)
      {
        SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
        Kept ofRanks(partition.blocks.size());
        ofAll(partition, change.before, change.shining, ofRanks);
        ExpectSameWarm(ofAll(partition, change.after, change.next, ofRanks), expected);
        ofRanks.back().kind.block.first[0] += 1;
        const LightField cold = ofAll(partition, change.after, change.next, ofRanks);
        EXPECT_THAT(cold.leftOut, testing::Contains(testing::HasSubstr("the blocks that the grid is cut into")));
        EXPECT_GT(cold.convergence.size(), expected.convergence.size());
      }
    }
  }

  static void ExpectSameWarm(const LightField& found, const LightField& expected)
  {
    EXPECT_EQ(found.convergence.size(), expected.convergence.size());
    EXPECT_EQ(found.sweepsSaved, expected.sweepsSaved);
    EXPECT_LT(LargestDifference(found.fluence, expected.fluence), 1e-6);
    EXPECT_LT(LargestDifference(found.fluenceDirect, expected.fluenceDirect), 1e-6);
    EXPECT_LT(LargestDifference(found.netFlux, expected.netFlux), 1e-5);
    EXPECT_LT(LargestDifference(found.scatteredMoments, expected.scatteredMoments), 1e-6);
    EXPECT_LT(LargestDifference(found.facePower, expected.facePower), 1e-6);
    // As published it is not closed (numerics.md, section 3).
    EXPECT_LT(found.balance.RelativeError(found.channels),
      std::max(1e-5, 1.0001 * expected.balance.RelativeError(expected.channels)));
    EXPECT_THAT(found.leftOut, testing::Contains(testing::HasSubstr("begun from the last light")));
    EXPECT_TRUE(found.converged);
  }
};

TEST_F(WarmStartsInBlocks, TakeTheOrdersOfTheWhole)
{
  const Grid grid = { { 6, 5, 7 }, { 1.0, 0.8, 1.3 } };
  Change change(grid, 3, 0.5f, 0.9f, ToTolerance(1e-4));
  change.TurnLamp();
  ExpectTheWarmLightOfTheWhole(
    change, "a lamp turned", { BlockPartition::Even(grid, 4), Uneven(grid), UnevenSlices(grid) });
  change.DarkenTo(0.85f);
  ExpectTheWarmLightOfTheWhole(change, "and an albedo edited", { BlockPartition::Even(grid, 3) });
}

TEST_F(WarmStartsInBlocks, TakeTheOrdersOfTheWholeInAngularMoments)
{
  const Grid grid = { { 6, 5, 4 } };
  Change change(grid, 1, 0.6f, 0.9f, ToTolerance(1e-4));
  for (RandomMedium* medium : { &change.before, &change.after })
  {
    medium->medium.phase = PhaseFunction::HenyeyGreenstein(0.7);
  }
  change.settings.angularDegree = 2;
  change.settings.directionsPerFace = 4;
  change.DarkenTo(0.88f);
  ExpectTheWarmLightOfTheWhole(change, "g 0.7", { UnevenSlices(grid) });
}

TEST_F(WarmStartsInBlocks, GoRoundPeriodicAxesBesideAFaceThatGivesBackLight)
{
  const Grid grid = { { 4, 3, 5 } };
  Change change(grid, 1, 0.5f, 0.8f, ToTolerance(1e-3));
  change.settings.periodic = { true, false, false };
  change.shining.faceAlbedo[4] = change.next.faceAlbedo[4] = { 0.7, 0.7, 0.7 };
  change.TurnLamp();
  change.DarkenTo(0.78f);
  ExpectTheWarmLightOfTheWhole(change, "periodic", { UnevenSlices(grid) });
}

TEST_F(WarmStartsInBlocks, ComeBackFromFaces)
{
  const Grid grid = { { 6, 5, 7 } };
  Change change(grid, 1, 0.5f, 0.9f, ToTolerance(1e-4));
  for (Illumination* light : { &change.shining, &change.next })
  {
    light->faceAlbedo[4] = { 0.7, 0.7, 0.7 };
  }
  change.TurnLamp();
  change.DarkenTo(0.88f);
  ExpectTheWarmLightOfTheWhole(change, "a white face", { BlockPartition::Even(grid, 3), UnevenSlices(grid) });
}

TEST_F(WarmStartsInBlocks, LetLightEscapeAlongFinerDirections)
{
  const Grid grid = { { 7, 6, 8 } };
  Change change(grid, 1, 0.6f, 0.9f, ToTolerance(1e-4));
  change.settings.uncollidedDirections = 36;
  change.DarkenTo(0.85f);
  ExpectTheWarmLightOfTheWhole(change, "finer directions", { UnevenSlices(grid) });
}

TEST_F(WarmStartsInBlocks, TakeFewerOrdersByCells)
{
  const Grid grid = { { 16, 15, 14 } };
  Change change(grid, 1, 0.45f, 0.98f, ToTolerance(1e-4));
  change.settings.acceleration = PropagationAcceleration::Automatic;
  change.settings.source = PropagationSource::Automatic;
  change.TurnLamp();
  ExpectTheWarmLightOfTheWhole(change, "by cells", { BlockPartition::Even(grid, 3), UnevenSlices(grid) });
}

TEST_F(WarmStartsInBlocks, TakeFewerSweepsByTheBalanceOfVoxels)
{
  const Grid grid = { { 7, 5, 6 } };
  Change change(grid, 3, 12.0f, 0.998f, ToTolerance(1e-4));
  change.settings.acceleration = PropagationAcceleration::Automatic;
  change.settings.source = PropagationSource::Automatic;
  change.TurnLamp();
  ExpectTheWarmLightOfTheWhole(change, "by balance", { Uneven(grid) });
  change.DarkenTo(0.997f);
  ExpectTheWarmLightOfTheWhole(change, "by balance, an albedo edited", { BlockPartition::Even(grid, 2) });
}

TEST_F(WarmStartsInBlocks, AreOfTheGridItselfWhereErrorsAreEstimatedOnACoarserOne)
{
  const Grid grid = { { 6, 4, 4 } };
  const Change change(grid, 1, 0.5f, 0.9f, ToTolerance(1e-3));
  const BlockPartition halves = BlockPartition::Even(grid, 2);
  Kept kept(2);
  const auto estimated = [&] {
    return LightOfAll(halves, change.before, change.shining,
      [&](Communicator& communicator, const Medium& medium, const Illumination& light) {
        return SolveWithErrorEstimate({ Domain(communicator, halves), medium, light }, change.settings, {},
          [&](const SceneBlock& block, const PropagationSettings& settings, const Monitor& monitor) {
            return SolveConservative(GetDevice(), block.domain, block.medium, block.illumination, settings, monitor,
              &block.medium == &medium ? &kept[communicator.Rank()] : nullptr);
          });
      });
  };
  const LightField first = estimated(), second = estimated();
  EXPECT_GT(second.sweepsSaved.back(), 0);
  EXPECT_EQ(second.convergence.size(), 2u) << "nothing changed";
  EXPECT_NEAR(second.relativeError, first.relativeError, 0.01 * first.relativeError);
}

TEST_F(WarmStartsInBlocks, BeginInTheDarkOnAllWhereLightDoesNotFitOnOne)
{
  const Grid grid = { { 8, 5, 6 } };
  Change change(grid, 1, 0.5f, 0.9f, ToTolerance(1e-3));
  const BlockPartition halves = BlockPartition::Even(grid, 2);
  const LightField cold = OfBlocks(halves, change.after, change.next, change.settings, nullptr);
  const auto expectCold = [&](Kept kept, const char* why) {
    const LightField found = OfBlocks(halves, change.after, change.next, change.settings, &kept);
    EXPECT_EQ(found.fluence, cold.fluence) << why;
    EXPECT_EQ(found.convergence.size(), cold.convergence.size()) << why;
    EXPECT_THAT(found.sweepsSaved, testing::Each(0)) << why;
    EXPECT_THAT(found.leftOut, testing::Contains(testing::HasSubstr(why)));
    const LightField again = OfBlocks(halves, change.after, change.next, change.settings, &kept);
    EXPECT_LE(again.convergence.size(), 3u) << "the new light is kept, not after: " << why;
  };
  Kept ofHalves(2);
  OfBlocks(halves, change.before, change.shining, change.settings, &ofHalves);

  Kept others = ofHalves;
  others[1] = {};
  expectCold(others, "there is none");
  others = ofHalves;
  others[0].kind.spacing[2] = 1.1;
  expectCold(others, "the grid has changed");
  others = ofHalves;
  others[1].rate[0] *= 0.9;
  expectCold(others, "of different solves");

  Kept ofSlices(2);
  const BlockPartition slices = { grid, { { { 0, 0, 0 }, { 3, 5, 6 } }, { { 3, 0, 0 }, { 5, 5, 6 } } } };
  OfBlocks(slices, change.before, change.shining, change.settings, &ofSlices);
  expectCold(ofSlices, "the blocks that the grid is cut into have changed");
  KeptLight ofWhole;
  SolveConservative(GetDevice(), change.before.medium, change.shining, change.settings, {}, &ofWhole);
  expectCold({ ofWhole, ofWhole }, "the blocks that the grid is cut into have changed");

  PropagationSettings fewer = change.settings;
  fewer.directionsPerFace = 4;
  OfBlocks(halves, change.before, change.shining, fewer, &others);
  expectCold(others, "the directions have changed");
}

TEST_F(WarmStartsInBlocks, AreOfAllRanksOrOfNone)
{
  const Grid grid = { { 4, 5, 6 } };
  const Change change(grid, 1, 0.5f, 0.9f, ToTolerance(1e-3));
  const BlockPartition halves = BlockPartition::Even(grid, 2);
  KeptLight kept;
  std::vector<std::string> errors(2);
  RunInThreads(2, [&](Communicator& communicator) {
    const int rank = communicator.Rank();
    const PartOf part(change.after, halves.blocks[rank]);
    try
    {
      SolveConservative(GetDevice(), Domain(communicator, halves), part.medium, change.next, change.settings, {},
        rank == 1 ? &kept : nullptr);
    }
    catch (const std::exception& error)
    {
      errors[rank] = error.what();
    }
  });
  EXPECT_THAT(errors, testing::Each(testing::HasSubstr("disagree about WarmStart")));
}

TEST_F(WarmStartsInBlocks, TakeTheOrdersOfTheWholeOfDiscreteOrdinates)
{
  const Grid grid = { { 4, 5, 3 } };
  OrdinatesSettings settings;
  settings.directionsPerFace = 4;
  settings.terms = 16;
  Change change(grid, 3, 0.5f, 0.9f, {});
  ExpectTheOrdersOfTheWhole(
    change, settings, { UnevenSlices(grid), Uneven(grid) },
    [&](const RandomMedium& medium, const Illumination& light, KeptLight* kept) {
      return SolveDiscreteOrdinates(GetDevice(), Domain(medium.medium.grid), medium.medium, light, settings, {}, kept);
    },
    [&](const BlockPartition& partition, Communicator& communicator, const Medium& medium, const Illumination& shining,
      KeptLight* kept) {
      return SolveDiscreteOrdinates(GetDevice(), Domain(communicator, partition), medium, shining, settings, {}, kept);
    });
}

TEST_F(WarmStartsInBlocks, TakeFewerSweepsByTheBalanceOfVoxelsInMoments)
{
  const Grid grid = { { 5, 4, 3 } };
  Change change(grid, 1, 8.0f, 0.99f, ToTolerance(1e-4));
  for (RandomMedium* medium : { &change.before, &change.after })
  {
    medium->medium.phase = PhaseFunction::HenyeyGreenstein(0.7);
  }
  change.settings.acceleration = PropagationAcceleration::Automatic;
  change.settings.source = PropagationSource::Linear;
  change.settings.angularDegree = 1;
  change.TurnLamp();
  ExpectTheWarmLightOfTheWhole(change, "by balance, in moments", { Uneven(grid) });
}
