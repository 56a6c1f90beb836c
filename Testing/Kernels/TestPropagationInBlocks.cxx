// The light of a medium that is spread over ranks, against that of the whole on one.

#include "BlocksOfLight.h"

#include <functional>
#include <string>
#include <vector>

using namespace blocks_of_light;

class PropagationBlocks : public DeviceTest
{
};

TEST_F(PropagationBlocks, HaveTheLightOfTheWholeOnOneToEightRanks)
{
  RandomMedium whole(Grid{ { 12, 9, 7 } }, 1, 0.8f, 5);
  whole.Emit(0.3f);
  const PropagationSettings settings = SettingsOf(0);
  const LightField expected = SolveConservative(GetDevice(), whole.medium, LitFromOutside(), settings);
  for (const int ranks : { 1, 2, 3, 4, 8 })
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
  for (std::size_t i = 0; i < whole.absorption.size(); ++i)
  {
    const float both = whole.absorption[i] + whole.scattering[i];
    whole.absorption[i] = 0.02f * both;
    whole.scattering[i] = 0.98f * both;
  }
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
  for (const int ranks : { 2, 3, 8 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    ExpectSame(onRanks(ranks), alone);
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
        SolveInBlocks(GetDevice(), communicator, partition, part.medium, shining, settings, monitor);
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
}

TEST_F(PropagationBlocksFail, WithWordsOnWhatIsNotCarriedFromRankToRank)
{
  ExpectErrors("not constant in voxels", [](int, PartOf&, Illumination&, PropagationSettings& settings, Monitor&) {
    settings.source = PropagationSource::Octants;
  });
  ExpectErrors("point, spot or rectangle", [](int, PartOf&, Illumination& shining, PropagationSettings&, Monitor&) {
    shining.lights[0].type = LightType::Point;
  });
}
