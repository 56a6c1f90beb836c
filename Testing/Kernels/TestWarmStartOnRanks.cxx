// The last light as the first guess on several ranks, each of which keeps that of its own block: the light of a serial
// solve that begins from its own, in as many orders (numerics.md, section 6.4).

#include "Difference.h"
#include "SolvedOnRanks.h"

#include "LightPropagation/Accuracy/ErrorEstimate.h"

#include <gmock/gmock.h>

using namespace tyndall;

namespace
{
using Kept = std::vector<KeptLight>; ///< by rank

/// A scene and what becomes of it: a sun that turns, a part of extinction that scatters less.
struct ChangedScene
{
  MediumToCut before, after;

  ChangedScene(std::array<int, 3> size, double densest, double albedo, double albedoThen)
    : before(Everything(size))
    , after(Everything(size))
  {
    this->before.scene.Randomise(densest, 1.0, albedo, 5);
    this->after.scene.Randomise(densest, 1.0, albedoThen, 5);
    this->after.scene.light.lights[0].direction = { 0.35, -0.45, -0.9 };
  }
  void Both(const std::function<void(Scene&)>& change)
  {
    change(this->before.scene);
    change(this->after.scene);
  }
};

/// Slices along x: the first a voxel wide, the second without any.
BlockPartition UnevenSlices(const Grid& grid)
{
  return Slices(grid, { 1, 1 });
}
}

template <class Solver>
class WarmStartOnRanks : public SolvedOnRanks<Solver>
{
protected:
  using Settings = typename Solver::Settings;

  LightField Of(const BlockPartition& partition, const MediumToCut& medium, const Settings& settings, Kept* kept)
  {
    return LightOnRanks(partition, medium, [&](const Domain& domain, MediumToCut& part) {
      return Solver::Solve(this->GetDevice(), domain, part, settings, {}, kept ? &kept->at(domain.Rank()) : nullptr);
    });
  }
  LightField AfterChange(const BlockPartition& partition, ChangedScene& change, const Settings& settings)
  {
    Kept kept(partition.blocks.size());
    change.before.Attach();
    change.after.Attach();
    const LightField first = this->Of(partition, change.before, settings, &kept);
    EXPECT_THAT(first.leftOut, testing::Contains(testing::HasSubstr("there is none")));
    EXPECT_THAT(first.sweepsSaved, testing::Each(0));
    const LightField warm = this->Of(partition, change.after, settings, &kept);
    EXPECT_THAT(warm.leftOut, testing::Contains(testing::HasSubstr("begun from the last light")));
    EXPECT_TRUE(warm.converged);
    ExpectEnergyKept(change.after, warm);
    return warm;
  }
  /// @param flux  largest difference of flux from that of a solve from darkness, over the tolerance
  void ExpectSerialOrders(ChangedScene& change, const Settings& settings, double flux = 4.0)
  {
    const Grid& grid = change.after.Grid();
    const BlockPartition one = BlockPartition::Even(grid, 1);
    const LightField warm = this->AfterChange(one, change, settings);
    const LightField cold = this->Of(one, change.after, settings, nullptr);
    EXPECT_LT(warm.convergence.size(), cold.convergence.size());
    EXPECT_LT(RelativeRmse(warm.fluence, cold.fluence), 2.0 * settings.tolerance);
    EXPECT_LT(RelativeRmse(warm.netFlux, cold.netFlux), flux * settings.tolerance);
    EXPECT_EQ(warm.fluenceDirect, cold.fluenceDirect);
    for (const BlockPartition& partition : { UnevenSlices(grid), Uneven(grid) })
    {
      const LightField found = this->AfterChange(partition, change, settings);
      EXPECT_EQ(found.convergence.size(), warm.convergence.size());
      EXPECT_EQ(found.sweepsSaved, warm.sweepsSaved);
      ExpectSameLight(found, warm, 1e-5);
      EXPECT_LT(RelativeDifference(found.fluence, warm.fluence), 1e-6);
    }
  }
};

using Solvers = testing::Types<ConservativeSolver, OrdinatesSolver>;
TYPED_TEST_SUITE(WarmStartOnRanks, Solvers);

TYPED_TEST(WarmStartOnRanks, TakesTheOrdersOfASerialSolve)
{
  ChangedScene change({ 6, 5, 7 }, 0.8, 0.9, 0.85);
  this->ExpectSerialOrders(change, TypeParam::Plain());
}

/// Beside a face that reflects light.
TYPED_TEST(WarmStartOnRanks, WrapsAroundPeriodicAxes)
{
  ChangedScene change({ 4, 3, 5 }, 8.0, 0.8, 0.78);
  change.Both([](Scene& scene) { scene.light.faceAlbedo[4] = { 0.7, 0.7, 0.7 }; });
  typename TypeParam::Settings settings = TypeParam::Plain();
  settings.tolerance = 1e-3;
  settings.periodic = { true, false, false };
  this->ExpectSerialOrders(change, settings);
}

TYPED_TEST(WarmStartOnRanks, BeginsInTheDarkOnAllWhereLightDoesNotFitOnOne)
{
  ChangedScene change({ 8, 5, 6 }, 0.8, 0.9, 0.85);
  const Grid& grid = change.after.Grid();
  const BlockPartition halves = BlockPartition::Even(grid, 2);
  typename TypeParam::Settings settings = TypeParam::Plain(), fewer = settings;
  settings.tolerance = fewer.tolerance = 1e-3;
  fewer.directionsPerFace = 4;
  const LightField cold = this->Of(halves, change.after, settings, nullptr);
  const auto expectCold = [&](Kept kept, const char* why) {
    const LightField found = this->Of(halves, change.after, settings, &kept);
    EXPECT_EQ(found.fluence, cold.fluence) << why;
    EXPECT_EQ(found.convergence.size(), cold.convergence.size()) << why;
    EXPECT_THAT(found.sweepsSaved, testing::Each(0)) << why;
    EXPECT_THAT(found.leftOut, testing::Contains(testing::HasSubstr(why)));
    EXPECT_LE(this->Of(halves, change.after, settings, &kept).convergence.size(), 3u) << "kept, not after: " << why;
  };
  Kept ofHalves(2), ofSlices(2), ofWhole(1);
  this->Of(halves, change.before, settings, &ofHalves);
  Kept others = ofHalves;
  others[1] = {};
  expectCold(others, "there is none");
  others = ofHalves;
  others[0].kind.spacing[2] = 1.1;
  expectCold(others, "the grid has changed");
  others = ofHalves;
  others[1].rate[0] *= 0.9;
  expectCold(others, "of different solves");
  this->Of(Slices(grid, { 3 }), change.before, settings, &ofSlices);
  expectCold(ofSlices, "the blocks that the grid is cut into have changed");
  this->Of(BlockPartition::Even(grid, 1), change.before, settings, &ofWhole);
  expectCold({ ofWhole[0], ofWhole[0] }, "the blocks that the grid is cut into have changed");
  this->Of(halves, change.before, fewer, &others);
  expectCold(others, "the directions have changed");
}

TYPED_TEST(WarmStartOnRanks, IsOfAllRanksOrOfNone)
{
  KeptLight kept;
  MediumToCut medium = Everything({ 4, 5, 6 });
  const auto errors = ErrorsOnRanks(BlockPartition::Even(medium.Grid(), 2), [&](const Domain& domain) {
    TypeParam::Solve(
      this->GetDevice(), domain, medium.Part(domain), TypeParam::Plain(), {}, domain.Rank() == 1 ? &kept : nullptr);
  });
  EXPECT_THAT(errors, testing::Each(testing::HasSubstr("disagree about WarmStart")));
}

class ConservativeWarmStart : public WarmStartOnRanks<ConservativeSolver>
{
};

TEST_F(ConservativeWarmStart, TakesTheOrdersOfASerialSolveInMomentsAlongFinerDirections)
{
  ChangedScene change({ 7, 6, 8 }, 0.6, 0.9, 0.85);
  change.Both([](Scene& scene) { scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.7); });
  PropagationSettings settings = ConservativeSolver::Plain();
  settings.angularDegree = 2;
  settings.uncollidedDirections = 36;
  this->ExpectSerialOrders(change, settings, 2.0);
}

TEST_F(ConservativeWarmStart, TakesFewerSweepsOfAcceleratedIterations)
{
  const std::pair<std::array<int, 3>, double> scenes[] = { { { 16, 15, 14 }, 0.5 }, { { 7, 5, 6 }, 12.0 } };
  for (const auto& [size, densest] : scenes) // by coarse cells, and by voxels
  {
    ChangedScene change(size, densest, 0.998, 0.997);
    PropagationSettings settings = ConservativeSolver::Plain();
    settings.acceleration = PropagationAcceleration::Automatic;
    settings.source = PropagationSource::Automatic;
    this->ExpectSerialOrders(change, settings);
  }
  ChangedScene moments({ 5, 4, 3 }, 8.0, 0.99, 0.99);
  moments.Both([](Scene& scene) { scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.7); });
  PropagationSettings settings = ConservativeSolver::Plain();
  settings.acceleration = PropagationAcceleration::Automatic;
  settings.source = PropagationSource::Linear;
  settings.angularDegree = 1;
  this->ExpectSerialOrders(moments, settings);
}

TEST_F(ConservativeWarmStart, IsOfTheGridItselfWhereErrorsAreEstimatedOnACoarserOne)
{
  MediumToCut medium = Everything({ 6, 4, 4 });
  const BlockPartition halves = BlockPartition::Even(medium.Grid(), 2);
  PropagationSettings settings = ConservativeSolver::Plain();
  settings.tolerance = 1e-3;
  Kept kept(2);
  const auto estimated = [&] {
    return LightOnRanks(halves, medium, [&](const Domain& domain, MediumToCut& part) {
      KeptLight* const last = &kept[domain.Rank()];
      const Medium* const own = &part.scene.medium;
      return SolveWithErrorEstimate({ domain, *own, part.scene.light }, settings, {},
        [this, last, own](const SceneBlock& scene, const PropagationSettings& of, const Monitor& monitor) {
          return SolveConservative(this->GetDevice(), scene.domain, scene.medium, scene.illumination, of, monitor,
            &scene.medium == own ? last : nullptr);
        });
    });
  };
  const LightField first = estimated(), second = estimated();
  EXPECT_GT(second.sweepsSaved.back(), 0);
  EXPECT_EQ(second.convergence.size(), 2u) << "nothing changed";
  EXPECT_NEAR(second.relativeError, first.relativeError, 0.01 * first.relativeError);
}
