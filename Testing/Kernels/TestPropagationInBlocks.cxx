// The light of a medium that is spread over ranks, against that of the whole on one.

#include "BlocksOfLight.h"
#include "TransparentBox.h"

#include "Device/Errors.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

using namespace blocks_of_light;
using namespace tyndall;

class PropagationBlocks : public DeviceTest
{
};

TEST_F(PropagationBlocks, HaveTheLightOfTheWholeOnOneToEightRanks)
{
  RandomMedium whole(Grid{ { 12, 9, 7 } }, 1, 0.8f, 5);
  whole.Emit(0.3f);
  const PropagationSettings settings = SettingsOf(0);
  const LightField expected = SolveConservative(GetDevice(), whole.medium, LitFromOutside(), settings);
  for (const int ranks : { 1, 3, 8 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    ExpectSame(
      LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, ranks), whole, LitFromOutside(), settings),
      expected);
  }
}

TEST_F(PropagationBlocks, HaveTheLightOfTheWholeInColourBySimilarity)
{
  RandomMedium whole(Grid{ { 6, 7, 5 } }, 3, 0.8f, 6);
  whole.Emit(0.3f);
  Illumination shining = LitFromOutside();
  shining.lights[0].power = { 1.0, 0.0, 3.0 };
  whole.medium.phase = PhaseFunction::HenyeyGreenstein(0.4);
  PropagationSettings settings = SettingsOf(3);
  settings.angularDegree = 0;
  ExpectSame(LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, 3), whole, shining, settings),
    SolveConservative(GetDevice(), whole.medium, shining, settings));
}

TEST_F(PropagationBlocks, GoOnBesideARankWithoutVoxels)
{
  RandomMedium whole(Grid{ { 2, 1, 1 } }, 1, 0.8f, 6);
  whole.Emit(0.3f);
  const PropagationSettings settings = SettingsOf(3);
  ExpectSame(LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, 4), whole, LitFromOutside(), settings),
    SolveConservative(GetDevice(), whole.medium, LitFromOutside(), settings));
}

namespace
{
/// Blocks of no common plane, one of them of one voxel's width, one without any.
BlockPartition UnevenBlocks(const Grid& grid)
{
  const std::array<int, 3>& n = grid.size;
  return { grid,
    { { { 0, 0, 0 }, { 5, n[1], n[2] } }, { { 5, 0, 0 }, { n[0] - 5, 1, n[2] } }, {},
      { { 5, 1, 0 }, { n[0] - 5, n[1] - 1, 4 } }, { { 5, 1, 4 }, { n[0] - 5, n[1] - 1, n[2] - 4 } } } };
}
}

/// Point, spot and rectangle lamps: beams go on from block to block, and lie over two of them.
TEST_F(PropagationBlocks, HaveTheLightOfLampsNearby)
{
  RandomMedium whole(Grid{ { 12, 9, 7 }, { 1.0, 0.8, 1.3 } }, 3, 0.8f, 7);
  const PropagationSettings settings = SettingsOf(3);
  for (const Light& lamp : NearLamps())
  {
    Illumination shining;
    shining.lights = { lamp };
    const LightField expected = SolveConservative(GetDevice(), whole.medium, shining, settings);
    std::vector<BlockPartition> partitions = { UnevenBlocks(whole.medium.grid) };
    for (const int ranks : { 1, 8 })
    {
      partitions.push_back(BlockPartition::Even(whole.medium.grid, ranks));
    }
    for (const BlockPartition& partition : partitions)
    {
      SCOPED_TRACE(std::to_string(static_cast<int>(lamp.type)) + " at " + std::to_string(lamp.position[0]) + ", " +
        std::to_string(partition.blocks.size()) + " ranks");
      const LightField found = LightOfAll(GetDevice(), partition, whole, shining, settings);
      ExpectSame(found, expected);
      EXPECT_LT(found.balance.RelativeError(3), 1e-6);
    }
  }
}

/// Beams that begin on faces far from their lamp, a cone that is thinner than a voxel, and a lamp that is a sun.
TEST_F(PropagationBlocks, HaveTheLightOfFarLampsAndNarrowCones)
{
  RandomMedium whole(Grid{ { 11, 7, 9 }, { 0.3, 1.0, 2.0 } }, 1, 0.8f, 8);
  for (const double distance : { 4e3, 4e8 })
  {
    Illumination shining;
    shining.lights = { NearLamps()[0], NearLamps()[1] };
    shining.lights[0].position = { 0.6 * distance, -0.2 * distance, -distance };
    shining.lights[0].power = Times(Rgb{ 3.0, 3.0, 3.0 }, distance * distance);
    shining.lights[1].position = { 1.8 + 0.01 * distance, 3.1, 8.0 + 0.02 * distance };
    shining.lights[1].direction = { -1.0, 0.0, -2.0 };
    shining.lights[1].angle = 1e-6;
    const LightField expected = SolveConservative(GetDevice(), whole.medium, shining, SettingsOf(2));
    EXPECT_GT(expected.balance.entered[0], 10.0);
    for (const BlockPartition& partition :
      { BlockPartition::Even(whole.medium.grid, 1), BlockPartition::Even(whole.medium.grid, 3) })
    {
      SCOPED_TRACE(std::to_string(distance) + ", " + std::to_string(partition.blocks.size()) + " ranks");
      ExpectSame(LightOfAll(GetDevice(), partition, whole, shining, SettingsOf(2)), expected);
    }
  }
}

/// On a face, on an edge, and where a face is also the border of a block; rectangles larger than the box and in it.
TEST_F(PropagationBlocks, HaveTheLightOfLampsOnTheBorderAndOfLargeRectangles)
{
  RandomMedium whole(Grid{ { 6, 5, 7 }, { 1.0, 0.8, 1.3 } }, 1, 0.8f, 7);
  std::vector<Light> lamps(5, NearLamps()[0]);
  lamps[0].position = { 0.0, 1.7, 9.1 };
  lamps[1].position = { 6.0, 1.7, 4.1 };
  lamps[2].position = { 3.0, 4.0, 4.0 };
  for (const int i : { 3, 4 })
  {
    lamps[i].type = LightType::Rectangle;
    lamps[i].direction = { 0.0, 0.1, -1.0 };
  }
  lamps[3].position = { 2.0, 4.0, 12.0 };
  lamps[3].size = { 70.0, 40.0 };
  lamps[4].position = { 3.0, 2.0, 5.0 };
  lamps[4].size = { 4.0, 3.0 };
  for (const Light& lamp : lamps)
  {
    Illumination shining;
    shining.lights = { lamp };
    const LightField expected = SolveConservative(GetDevice(), whole.medium, shining, SettingsOf(2));
    for (const int ranks : { 1, 3 })
    {
      SCOPED_TRACE(std::to_string(lamp.position[2]) + ", " + std::to_string(ranks) + " ranks");
      const BlockPartition partition = BlockPartition::Even(whole.medium.grid, ranks);
      const LightField found = LightOfAll(GetDevice(), partition, whole, shining, SettingsOf(2));
      ExpectSame(found, expected);
      EXPECT_LT(found.balance.RelativeError(3), 1e-6);
    }
  }
}

/// The same in angular moments, between faces that give back light, and with what leaves by cells of faces.
TEST_F(PropagationBlocks, HaveTheLightOfLampsNearbyInMomentsAndBetweenFaces)
{
  RandomMedium whole(Grid{ { 7, 8, 6 } }, 1, 0.7f, 11);
  Illumination shining;
  shining.lights = { NearLamps()[0], NearLamps()[3] };
  shining.faceAlbedo[4] = { 0.7, 0.7, 0.7 };
  PropagationSettings settings = SettingsOf(3);
  ExpectTheLightOfTheWhole(GetDevice(), whole, shining, settings);
  shining.faceAlbedo = {};
  settings.facePower = true;
  ExpectTheLightOfTheWhole(GetDevice(), whole, shining, settings);
  settings.facePower = false;
  whole.medium.phase = PhaseFunction::HenyeyGreenstein(0.7);
  ExpectTheLightOfTheWhole(GetDevice(), whole, shining, settings);
}

/// Beams go on beyond the ends, in passes; of a box without faces the rest of them is spread evenly.
TEST_F(PropagationBlocks, HaveTheLightOfLampsNearbyThatGoesRoundPeriodicAxes)
{
  const std::array<bool, 3> periodic[] = { { true, false, false }, { false, true, true }, { true, true, true } };
  const double densities[] = { 0.8, 0.3, 0.05 };
  for (int i = 0; i < 3; ++i)
  {
    RandomMedium whole(Grid{ { 7, 5, 6 }, { 1.0, 0.8, 1.3 } }, i == 1 ? 3 : 1, densities[i], 14 + i);
    Illumination shining;
    shining.lights = { NearLamps()[i], NearLamps()[3] };
    PropagationSettings settings = SettingsOf(1);
    settings.periodic = periodic[i];
    const LightField expected = SolveConservative(GetDevice(), whole.medium, shining, settings);
    for (const BlockPartition& partition : { BlockPartition::Even(whole.medium.grid, 1),
           BlockPartition::Even(whole.medium.grid, 3), UnevenBlocks(whole.medium.grid) })
    {
      SCOPED_TRACE(std::to_string(i) + ", " + std::to_string(partition.blocks.size()) + " ranks");
      ExpectSame(LightOfAll(GetDevice(), partition, whole, shining, settings), expected, true);
    }
  }
}

TEST_F(PropagationBlocks, LoseNothingOfALampInABoxWithoutFaces)
{
  for (const float densest : { 0.05f, 0.7f })
  {
    RandomMedium whole(Grid{ { 12, 9, 10 } }, 1, densest, 3);
    Share(whole, 1.0f, 0.0f);
    Illumination shining;
    shining.lights = { NearLamps()[0] };
    PropagationSettings settings = SettingsOf(1);
    settings.periodic = { true, true, true };
    for (const int ranks : { 1, 3 })
    {
      const LightField light =
        LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, ranks), whole, shining, settings);
      EXPECT_NEAR(light.balance.absorbed[0], light.balance.entered[0], 5e-5 * light.balance.entered[0]) << ranks;
    }
  }
}

namespace
{
/// No voxel takes light, and all emit.
RandomMedium Glow(const Grid& grid)
{
  RandomMedium glow(grid, 1, 0.0f);
  glow.Emit(1.0f);
  std::fill(glow.emission.begin(), glow.emission.end(), 1.0f);
  return glow;
}
}

/// Of an odd number of directions along the edge of a cube's face one goes along an axis: its light never ends, and is
/// left over.
TEST_F(PropagationBlocks, EndWhereLightAlongAPeriodicAxisDoesNot)
{
  RandomMedium whole = Glow(Grid{ { 4, 3, 3 } });
  whole.absorption[3] = 0.5f;
  PropagationSettings settings = SettingsOf(0);
  settings.periodic = { true, false, false };
  const LightField expected = SolveConservative(GetDevice(), whole.medium, {}, settings);
  EXPECT_LT(expected.convergence.size(), 20u);
  EXPECT_LT(expected.balance.RelativeError(1), 1e-5);
  EXPECT_GT(expected.balance.leftOver[0], 0.01 * expected.balance.emitted[0]);
  ASSERT_EQ(expected.doubts.size(), 1u);
  EXPECT_NE(expected.doubts[0].find("left over: its rays still go round periodic axes"), std::string::npos);
  for (const int ranks : { 1, 3 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    ExpectSame(
      LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, ranks), whole, {}, settings), expected, true);
  }
}

/// What empty voxels emit has directions of its own, none along such an axis: the light is that of a rod without ends.
TEST_F(PropagationBlocks, HaveTheLightOfAnEmittingVacuumAlongAPeriodicAxis)
{
  const RandomMedium whole = Glow(Grid{ { 4, 4, 4 } });
  const auto expectRod = [](const LightField& light) {
    const double mean = std::accumulate(light.fluence.begin(), light.fluence.end(), 0.0) / 64.0;
    const double rod = MeanFluenceOfTransparentBox({ std::numeric_limits<double>::infinity(), 4.0, 4.0 });
    EXPECT_NEAR(mean / rod, 1.0, 0.08);
    EXPECT_LT(light.balance.leftOver[0], 1e-6 * light.balance.emitted[0]);
  };
  PropagationSettings settings;
  settings.periodic = { true, false, false };
  settings.directionsPerFace = 9;
  expectRod(SolveConservative(GetDevice(), whole.medium, {}, settings));
  expectRod(LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, 3), whole, {}, settings));
}

TEST_F(PropagationBlocks, HaveTheLightOfALampThatGoesRoundVoxelByVoxel)
{
  RandomMedium whole(Grid{ { 2, 1, 3 } }, 1, 0.5f, 17);
  Illumination shining;
  shining.lights = { NearLamps()[3] };
  shining.lights[0].position = { 0.7, 0.4, 2.2 };
  PropagationSettings settings = SettingsOf(1);
  settings.periodic = { true, true, false };
  const LightField expected = SolveConservative(GetDevice(), whole.medium, shining, settings);
  ExpectSame(LightOfAll(GetDevice(), VoxelByVoxel(whole.medium.grid), whole, shining, settings), expected, true);
}

/// What beams put down is in fixed point: it does not matter on which rank.
TEST_F(PropagationBlocks, HaveTheUncollidedLightOfALampBesideThemBitForBit)
{
  RandomMedium whole(Grid{ { 4, 3, 2 } }, 1, 0.8f, 9);
  Illumination shining;
  shining.lights = { NearLamps()[3] };
  const auto onRanks = [&](int ranks) {
    return LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, ranks), whole, shining, SettingsOf(2));
  };
  const LightField expected = onRanks(1);
  for (const int ranks : { 3, 24, 26 }) // blocks of one voxel, and none
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    const LightField found = onRanks(ranks);
    EXPECT_EQ(found.fluenceDirect, expected.fluenceDirect);
    ExpectSame(found, expected);
  }
}

/// Unscattered light along directions of its own, and what scattered light lets out otherwise.
TEST_F(PropagationBlocks, HaveTheLightOfTheWholeAlongFinerDirectionsFromOutside)
{
  RandomMedium whole(Grid{ { 9, 7, 8 } }, 1, 0.6f, 7);
  whole.Emit(0.3f);
  PropagationSettings settings = SettingsOf(4);
  settings.uncollidedDirections = 36;
  ExpectTheLightOfTheWhole(GetDevice(), whole, LitFromOutside(), settings);
  Illumination shining = LitFromOutside();
  shining.faceAlbedo[2] = { 0.6, 0.6, 0.6 };
  ExpectTheLightOfTheWhole(GetDevice(), whole, shining, settings);
  whole.medium.phase = PhaseFunction::HenyeyGreenstein(0.8);
  ExpectTheLightOfTheWhole(GetDevice(), whole, LitFromOutside(), settings);
}

/// Thin voxels in which light is scattered many times: diffusion on cells goes with the sweeps, and does not change
/// what they come to.
TEST_F(PropagationBlocks, FindTheSameLightSoonerByCells)
{
  RandomMedium whole(Grid{ { 22, 19, 18 } }, 1, 0.5f, 5);
  Share(whole, 0.02f, 0.98f);
  whole.Emit(0.3f);
  PropagationSettings settings = SettingsOf(0);
  settings.tolerance = 1e-6;
  const LightField plain = SolveConservative(GetDevice(), whole.medium, LitFromOutside(), settings);
  settings.acceleration = PropagationAcceleration::Automatic;
  const auto onRanks = [&](int ranks) {
    return LightOfAll(GetDevice(), BlockPartition::Even(whole.medium.grid, ranks), whole, LitFromOutside(), settings);
  };
  const LightField alone = onRanks(1);
  EXPECT_LT(2 * alone.convergence.size(), plain.convergence.size());
  EXPECT_LT(RelativeRmse(alone.fluence, plain.fluence), 5e-6);
  EXPECT_LT(RelativeRmse(alone.netFlux, plain.netFlux), 5e-6);
  EXPECT_LT(alone.balance.RelativeError(1), 1e-6);
  for (const int ranks : { 3, 8 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    ExpectSame(onRanks(ranks), alone);
  }
}

/// As the whole has it by cells, of light that is linear across voxels, in blocks of any sizes.
TEST_F(PropagationBlocks, HaveTheLightOfTheWholeByCells)
{
  RandomMedium whole(Grid{ { 22, 19, 18 }, { 1.0, 0.9, 1.1 } }, 3, 0.45f, 5);
  Share(whole, 0.02f, 0.98f);
  whole.Emit(0.3f);
  PropagationSettings settings = SettingsOf(0);
  settings.acceleration = PropagationAcceleration::Automatic;
  settings.source = PropagationSource::Automatic;
  settings.tolerance = 1e-5;
  const LightField expected = SolveConservative(GetDevice(), whole.medium, LitFromOutside(), settings);
  settings.source = PropagationSource::Constant;
  const LightField constant = SolveConservative(GetDevice(), whole.medium, LitFromOutside(), settings);
  EXPECT_GT(RelativeRmse(constant.fluence, expected.fluence), 1e-3);
  settings.source = PropagationSource::Automatic;
  const BlockPartition one = BlockPartition::Even(whole.medium.grid, 1);
  const LightField alone = LightOfAll(GetDevice(), one, whole, LitFromOutside(), settings);
  EXPECT_LT(RelativeRmse(alone.fluence, expected.fluence), 1e-5);
  EXPECT_LT(RelativeRmse(alone.netFlux, expected.netFlux), 2e-5);
  EXPECT_EQ(alone.convergence.size(), expected.convergence.size());
  EXPECT_LT(alone.balance.RelativeError(3), 1e-6);
  for (int face = 0; face < 6; ++face)
  {
    EXPECT_NEAR(alone.facePowerOut[face][0], expected.facePowerOut[face][0], 1e-5 * expected.facePowerOut[face][0]);
  }
  for (const BlockPartition& partition : { BlockPartition::Even(whole.medium.grid, 3), Uneven(whole.medium.grid) })
  {
    ExpectSame(LightOfAll(GetDevice(), partition, whole, LitFromOutside(), settings), alone);
  }
}

/// Whatever goes wrong on one rank is one error on each, and none waits for the others.
class PropagationBlocksFail : public PropagationBlocks
{
protected:
  /// @param change  of what a rank is given
  /// @return the errors by rank
  std::vector<std::string> Errors(
    const std::function<void(int rank, PartOf&, Illumination&, PropagationSettings&, Monitor&)>& change)
  {
    RandomMedium whole(Grid{ { 6, 5, 4 } }, 1, 0.8f, 6);
    whole.Emit(0.3f);
    const BlockPartition partition = BlockPartition::Even(whole.medium.grid, 3);
    std::vector<std::string> errors(3);
    RunInThreads(3, [&](Communicator& communicator) {
      const int rank = communicator.Rank();
      PartOf part(whole, partition.blocks[rank]);
      Illumination shining = LitFromOutside();
      PropagationSettings settings = SettingsOf(2);
      Monitor monitor;
      change(rank, part, shining, settings, monitor);
      try
      {
        SolveConservative(GetDevice(), Domain(communicator, partition), part.medium, shining, settings, monitor);
      }
      catch (const std::exception& error)
      {
        errors[rank] = error.what();
      }
    });
    return errors;
  }

  void ExpectErrors(const std::string& words,
    const std::function<void(int rank, PartOf&, Illumination&, PropagationSettings&, Monitor&)>& change)
  {
    for (const std::string& error : Errors(change))
    {
      EXPECT_NE(error.find(words), std::string::npos) << error;
    }
  }
};

TEST_F(PropagationBlocksFail, TogetherWhereOneHasBadInput)
{
  ExpectErrors("sigma_a", [](int rank, PartOf& part, Illumination&, PropagationSettings&, Monitor&) {
    part.absorption[0] = rank == 1 ? -1.0f : part.absorption[0];
  });
}

TEST_F(PropagationBlocksFail, TogetherWhereTheyDisagree)
{
  ExpectErrors(
    "disagree about the components", [](int rank, PartOf& part, Illumination&, PropagationSettings&, Monitor&) {
      part.medium.emission = rank == 2 ? Field() : part.medium.emission;
    });
  ExpectErrors("disagree about g", [](int rank, PartOf& part, Illumination&, PropagationSettings& settings, Monitor&) {
    part.medium.phase = PhaseFunction::HenyeyGreenstein(0.1 + 0.1 * rank);
    settings.angularDegree = 0;
  });
  ExpectErrors(
    "disagree about settings", [](int rank, PartOf&, Illumination&, PropagationSettings& settings, Monitor&) {
      settings.tolerance *= 1.0 + rank;
    });
  ExpectErrors(
    "disagree about settings", [](int rank, PartOf&, Illumination&, PropagationSettings& settings, Monitor&) {
      settings.acceleration = PropagationAcceleration::Automatic;
      settings.source = rank == 1 ? PropagationSource::Linear : PropagationSource::Constant;
    });
  ExpectErrors("disagree about what shines",
    [](int rank, PartOf&, Illumination& shining, PropagationSettings&, Monitor&) { shining.faces[3][0] += rank; });
}

TEST_F(PropagationBlocksFail, TogetherWhereOneIsStopped)
{
  ExpectErrors("aborted", [](int rank, PartOf&, Illumination&, PropagationSettings&, Monitor& monitor) {
    if (rank == 1)
    {
      monitor = [](double done) { return done < 0.5; };
    }
  });
  const auto isBalanced = [](PropagationSettings& settings) {
    settings.acceleration = PropagationAcceleration::Automatic;
    settings.source = PropagationSource::Linear;
    settings.maximumOrders = 0;
  };
  for (const double until : { 0.1, 0.7 }) // in the light of the lamp, and of the sweeps
  {
    ExpectErrors("aborted", [&](int rank, PartOf&, Illumination&, PropagationSettings& settings, Monitor& monitor) {
      isBalanced(settings);
      if (rank == 2)
      {
        monitor = [until](double done) { return done < until; };
      }
    });
  }
}

// A lamp within an opaque block in vacuum, more than floats can carry: the whole refuses it (Extremes).
TEST_F(PropagationBlocks, RefuseLightThatDoesNotBalanceOnAnyNumberOfRanks)
{
  RandomMedium whole(Grid{ { 9, 9, 9 } }, 1, 0.0f);
  for (int i = 0; i < 27; ++i)
  {
    whole.scattering[whole.medium.grid.IndexOf({ 3 + i % 3, 3 + i / 3 % 3, 3 + i / 9 })] = 1e30f;
  }
  Illumination shining;
  Light lamp;
  lamp.type = LightType::Point;
  lamp.position = { 4.5, 4.5, 4.5 };
  shining.lights = { lamp };
  for (const int ranks : { 1, 3 })
  {
    const BlockPartition partition = BlockPartition::Even(whole.medium.grid, ranks);
    RunInThreads(ranks, [&](Communicator& communicator) {
      PartOf part(whole, partition.blocks[communicator.Rank()]);
      std::string said;
      try
      {
        const LightField light = SolveConservative(
          this->GetDevice(), Domain(communicator, partition), part.medium, shining, PropagationSettings());
        said = "balances to " + std::to_string(light.balance.RelativeError(1));
      }
      catch (const InvalidInput& error)
      {
        said = error.what();
      }
      EXPECT_NE(said.find("Its thickest voxel, (3, 3, 3), has optical thickness 1e+30"), std::string::npos)
        << ranks << ": " << said;
    });
  }
}
