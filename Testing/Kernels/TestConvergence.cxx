#include "ErrorWords.h"
#include "LightPropagation/Convergence.h"

#include "Device/Errors.h"
#include "RanksInThreads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <mutex>

using namespace tyndall;

namespace
{
LightField LightWith(double residual, double leftOver)
{
  LightField light;
  light.convergence.resize(7);
  light.convergence.back().residual = residual;
  light.balance.entered = { 3.0, 0.0, 0.0 };
  light.balance.emitted = { 1.0, 0.0, 0.0 };
  light.balance.leftOver = { 4.0 * leftOver, 0.0, 0.0 };
  return light;
}
}

TEST(Convergence, IsAResidualNotAboveTheTolerance)
{
  PropagationSettings settings;
  settings.tolerance = 1e-3;
  LightField light = LightWith(1e-3, 0.0);
  JudgeConvergence(settings, light);
  EXPECT_TRUE(light.converged);
  EXPECT_TRUE(light.doubts.empty());

  light = LightWith(1.1e-3, 0.0);
  JudgeConvergence(settings, light);
  EXPECT_FALSE(light.converged);
  ASSERT_EQ(light.doubts.size(), 1u);
  EXPECT_NE(light.doubts[0].find("after 7 sweeps its estimated relative error is 0.0011, Tolerance is 0.001"),
    std::string::npos)
    << light.doubts[0];
}

TEST(Convergence, IsNotAskedForWhereOrdersAreCounted)
{
  PropagationSettings settings;
  settings.maximumOrders = 7;
  LightField light = LightWith(0.5, 0.5);
  JudgeConvergence(settings, light);
  EXPECT_TRUE(light.converged);
  EXPECT_TRUE(light.doubts.empty());
}

TEST(Convergence, DoubtsLightOfWhichAHundredthIsLeftOver)
{
  LightField light = LightWith(0.0, 0.0099);
  JudgeConvergence({}, light);
  EXPECT_TRUE(light.doubts.empty());

  light = LightWith(0.0, 0.0101);
  JudgeConvergence({}, light);
  EXPECT_TRUE(light.converged);
  ASSERT_EQ(light.doubts.size(), 1u);
  EXPECT_NE(light.doubts[0].find("1.01% is left over"), std::string::npos) << light.doubts[0];
}

namespace
{
/// What each of some ranks, of which one is not told the same, does about a balance that is off by part of the power.
struct Judged
{
  int refused = 0;
  std::vector<std::string> words;
};

Judged JudgeOnRanks(int ranks, double lost, double lostOnLast)
{
  Judged judged;
  std::mutex guard;
  RunInThreads(ranks, [&](Communicator& communicator) {
    LightField light = LightWith(0.0, 0.0);
    const float sigma = 0.5f;
    Medium medium;
    medium.grid.size = { 1, 1, 1 };
    medium.sigma_a = { &sigma, 1 };
    medium.sigma_s = { &sigma, 1 };
    light.balance.absorbed[0] = 4.0 - 4.0 * (communicator.Rank() + 1 == ranks ? lostOnLast : lost);
    std::string word;
    bool refused = false;
    try
    {
      JudgeBalance(light, Domain(communicator, BlockPartition::Even(medium.grid, ranks)), medium);
      word = light.doubts.empty() ? "" : light.doubts[0];
    }
    catch (const InvalidInput& error)
    {
      refused = true;
      word = error.what();
    }
    const std::lock_guard<std::mutex> lock(guard);
    judged.refused += refused ? 1 : 0;
    judged.words.push_back(word);
  });
  return judged;
}
}

TEST(Balance, IsJudgedAlikeOnAllRanks)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const int ranks : { 1, 3 })
  {
    EXPECT_EQ(JudgeOnRanks(ranks, 0.9e-4, 0.9e-4).words, std::vector<std::string>(ranks, "")) << ranks;
    const Judged poor = JudgeOnRanks(ranks, 2.5e-4, 2.5e-4), bad = JudgeOnRanks(ranks, 0.36, 0.36),
                 none = JudgeOnRanks(ranks, 0.0, nan);
    EXPECT_EQ(poor.refused, 0) << ranks;
    EXPECT_EQ(bad.refused, ranks);
    EXPECT_EQ(none.refused, ranks);
    for (int rank = 0; rank < ranks; ++rank)
    {
      EXPECT_EQ(poor.words[rank].find("The energy balance is off: 0.00025 of the power is lost or made"), 0u);
      EXPECT_NE(poor.words[rank].find("Voxels of at most 1 mean free paths are not the cause"), std::string::npos);
      EXPECT_EQ(bad.words[rank].find("The light does not balance: 0.36 of the power is lost or made"), 0u);
    }
  }
}

TEST(Balance, BlamesAMediumThatIsThickEnough)
{
  const std::vector<float> sigma = { 1.0f, 2e6f };
  Medium medium;
  medium.grid.size = { 2, 1, 1 };
  medium.sigma_a = { sigma.data(), 1 };
  medium.sigma_s = { sigma.data(), 1 };
  LightField light = LightWith(0.0, 0.0); // nothing is absorbed, nothing leaves
  const std::string words = ErrorWords([&] { JudgeBalance(light, Domain(medium.grid), medium); });
  EXPECT_THAT(words, testing::HasSubstr("Its thickest voxel, (1, 0, 0), has optical thickness 4e+06"));
}

TEST(Balance, OfAFaintChannelCountsByTheBrightestOne)
{
  LightField light = LightWith(0.0, 0.0);
  light.balance.entered = { 3.0, 0.0, 1e-8 }; // beside 1 W that is emitted
  light.balance.absorbed = { 4.0, 0.0, 0.0 }; // photons' channels share their units of power
  JudgeBalance(light, Domain(Grid()), Medium());
  EXPECT_TRUE(light.doubts.empty());
  light.balance.absorbed[0] = 3.9;
  EXPECT_THROW(JudgeBalance(light, Domain(Grid()), Medium()), InvalidInput);
}

/// Whose sum is right.
TEST(Balance, RefusesPowersThatNoneCanBe)
{
  const auto judge = [](double absorbed, double escaped, double leftOver) -> std::string {
    LightField light = LightWith(0.0, leftOver);
    light.balance.absorbed[0] = 4.0 * absorbed;
    light.balance.escaped[0] = 4.0 * escaped;
    try
    {
      JudgeBalance(light, Domain(Grid()), Medium());
    }
    catch (const InvalidInput& error)
    {
      return error.what();
    }
    return light.doubts.empty() ? "" : light.doubts[0];
  };
  EXPECT_EQ(judge(-0.81, 0.0, 1.81).find("The light has no meaning: of 4 W, -3.24 W are absorbed"), 0u);
  EXPECT_EQ(judge(1.02, -0.02, 0.0).find("The light has no meaning"), 0u);
  EXPECT_EQ(judge(0.0, 0.0, 1.0), "");
  EXPECT_EQ(judge(1.0 + 5e-5, 0.0, -5e-5), "");
}

TEST(Balance, BlamesNoLampWhereTheMediumAloneShines)
{
  LightField light = LightWith(0.0, 0.0);
  for (const bool enters : { false, true })
  {
    light.balance.entered[0] = enters ? 3.0 : 0.0;
    const std::string words = ErrorWords([&] { JudgeBalance(light, Domain(Grid()), Medium()); });
    EXPECT_NE(words, "");
    EXPECT_EQ(words.find("lamps") != std::string::npos, enters) << words;
  }
}

TEST(Convergence, NamesAccelerationWhereTheSolverHasIt)
{
  const auto names = [](PropagationAcceleration acceleration, bool accelerates) {
    PropagationSettings settings;
    settings.acceleration = acceleration;
    LightField light = LightWith(1.0, 0.0);
    JudgeConvergence(settings, light, accelerates);
    return light.doubts.at(0).find("Acceleration") != std::string::npos;
  };
  EXPECT_TRUE(names(PropagationAcceleration::Automatic, true));
  EXPECT_FALSE(names(PropagationAcceleration::None, true));
  EXPECT_FALSE(names(PropagationAcceleration::Automatic, false));
}

TEST(Convergence, CountsOfLightThatWasForeseenWhatWasNot)
{
  EXPECT_DOUBLE_EQ(GoesOnAsForeseen(0.0, 0.0, 0.2), 0.2);
  EXPECT_DOUBLE_EQ(GoesOnAsForeseen(0.0, 0.5, 0.2), 0.7); // nothing has ended yet
  EXPECT_DOUBLE_EQ(GoesOnAsForeseen(1.0, 0.75, 0.01), 0.01);
  EXPECT_DOUBLE_EQ(GoesOnAsForeseen(1.0, 0.9999999, 1e-4), 1e-4);
}
