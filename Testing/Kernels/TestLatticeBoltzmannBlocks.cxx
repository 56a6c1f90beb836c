// Steps as published: explicit collisions, and blocks that exchange light now and then.

#include "Difference.h"
#include "ErrorWords.h"
#include "LatticeScene.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

using namespace tyndall;

namespace
{
LatticeSettings AsPublished(int directions)
{
  LatticeSettings settings;
  settings.directions = directions;
  settings.scheme = LatticeScheme::Published;
  return settings;
}

bool IsPositive(const LightField& light)
{
  return std::all_of(light.fluence.begin(), light.fluence.end(), [](float fluence) { return fluence >= 0.0f; });
}
}

class PublishedLattices : public LatticeTest
{
protected:
  /// Something bright in the middle of voxels of one thickness.
  LightField StepsFrom(double thickness, double albedo, const LatticeSettings& settings)
  {
    Scene scene({ 9, 9, 9 }, static_cast<float>(thickness * (1.0 - albedo)), static_cast<float>(thickness * albedo));
    scene.emission.assign(scene.sigma_s.size(), 0.0f);
    scene.emission[364] = 1.0f;
    return this->Solve(scene, settings);
  }
};

/// Geist et al., section 3: (2 / sigma_t - 1) / 4 with 18 directions; with 6, (2 / sigma_t - 1) / 6.
TEST_F(PublishedLattices, SpreadAsTheirPaperSays)
{
  for (const int directions : { 6, 18 })
  {
    const double thickness = 0.6, diffusion = (2.0 / thickness - 1.0) / (directions == 6 ? 6.0 : 4.0);
    for (const double growth : this->GrowthOver(diffusion, AsPublished(directions), thickness))
    {
      EXPECT_NEAR(growth, 1.0, 0.01) << directions;
    }
  }
}

TEST_F(PublishedLattices, HoldUpToOneAndWarnBeyond)
{
  for (const int directions : { 6, 18 })
  {
    for (const double albedo : { 0.2, 0.9, 1.0 })
    {
      LatticeSettings settings = AsPublished(directions);
      settings.maximumSteps = 40;
      const LightField holds = this->StepsFrom(1.0, albedo, settings);
      EXPECT_TRUE(IsPositive(holds)) << albedo;
      EXPECT_FALSE(Says(holds.doubts, "at most 1")) << albedo;
      const LightField breaks = this->StepsFrom(2.4, albedo, settings);
      EXPECT_FALSE(IsPositive(breaks)) << albedo;
      EXPECT_TRUE(Says(breaks.doubts, "at most 1")) << albedo;
      settings.scheme = LatticeScheme::Conservative;
      const LightField kept = this->StepsFrom(2.4, albedo, settings);
      EXPECT_TRUE(IsPositive(kept)) << albedo;
      EXPECT_TRUE(kept.doubts.empty()) << albedo;
    }
  }
}

TEST_F(PublishedLattices, AreRefusedWhereTheyGrowBeyondAllNumbers)
{
  LatticeSettings settings = AsPublished(18);
  settings.maximumSteps = 2000;
  const std::string words = ErrorWords([&] { this->StepsFrom(4.0, 1.0, settings); });
  EXPECT_THAT(words, testing::HasSubstr("conservative scheme"));
}

/// Odd moments vanish and those of degree 4 are even in all directions with 18 links; 6 favour the axes.
TEST_F(PublishedLattices, SpreadEvenlyIn18DirectionsNotIn6)
{
  LatticeSettings settings;
  const Spread even = this->SpreadOfPulse(settings, 0.4, 12);
  EXPECT_NEAR(even.fourth[3] / even.fourth[0], 1.0, 1e-5);
  settings.directions = 6;
  const Spread uneven = this->SpreadOfPulse(settings, 0.4, 12);
  EXPECT_LT(uneven.fourth[3] / uneven.fourth[0], 0.9);
  RecordProperty("FourthMomentDiagonalOverAxisOf18", std::to_string(even.fourth[3] / even.fourth[0] - 1.0));
  RecordProperty("FourthMomentDiagonalOverAxisOf6", std::to_string(uneven.fourth[3] / uneven.fourth[0] - 1.0));
}

/// One block that holds all voxels has nothing to exchange but what comes from outside.
TEST_F(PublishedLattices, OfOneBlockStepAsAllVoxelsDo)
{
  for (const LatticeScheme scheme : { LatticeScheme::Published, LatticeScheme::Conservative })
  {
    Scene scene({ 5, 4, 3 });
    scene.Randomise(0.9, 2.0, 0.9, 4);
    scene.light.faces[3] = { 1.0, 1.0, 1.0 };
    LatticeSettings settings;
    settings.scheme = scheme;
    settings.maximumSteps = 20;
    const LightField together = this->Solve(scene, settings);
    settings.blockSize = 8;
    settings.stepsPerExchange = 5;
    EXPECT_LT(RelativeDifference(this->Solve(scene, settings).fluence, together.fluence), 1e-6);
  }
}

/// Blocks that exchange after each step do what all voxels do together.
TEST_F(PublishedLattices, OfBlocksThatExchangeAtEachStepAreAsOne)
{
  Scene scene({ 9, 7, 10 });
  scene.Randomise(3.0, 2.0, 0.9, 4);
  scene.light.faces[3] = { 1.0, 1.0, 1.0 };
  const std::vector<float> ior(scene.sigma_s.size(), 1.0f);
  for (const int directions : { 6, 18 })
  {
    for (const bool periodic : { false, true })
    {
      LatticeSettings settings;
      settings.directions = directions;
      settings.periodic = { periodic, false, periodic };
      settings.maximumSteps = 30;
      const LightField together = this->Solve(scene, settings);
      settings.blockSize = 4;
      settings.stepsPerExchange = 1;
      EXPECT_LT(RelativeDifference(this->Solve(scene, settings).fluence, together.fluence), 1e-6) << directions;
    }
  }
}

/// Figure 6 of Bernabei et al.
TEST_F(PublishedLattices, OfBlocksSettleToTheLightOfAllVoxels)
{
  for (const LatticeScheme scheme : { LatticeScheme::Published, LatticeScheme::Conservative })
  {
    for (const double albedo : { 0.5, 0.9, 0.999 })
    {
      Scene scene({ 14, 9, 11 });
      scene.Randomise(0.9, 1.0, albedo, 8);
      scene.ShineAlong({ 0.2, 0.3, -1.0 });
      scene.light.faces[0] = { 0.2, 0.2, 0.2 };
      LatticeSettings settings;
      settings.scheme = scheme;
      settings.solvesSteady = false;
      settings.tolerance = 1e-5;
      const LightField together = this->Solve(scene, settings);
      settings.blockSize = 4;
      const LightField blocks = this->Solve(scene, settings);
      EXPECT_LT(RelativeDifference(blocks.fluence, together.fluence), 1e-3) << albedo;
      EXPECT_LT(std::abs(blocks.balance.leftOver[0]), 1e-3 * blocks.balance.entered[0]) << albedo;
      for (std::size_t i = 0; i < together.fluence.size(); ++i)
      {
        ASSERT_NEAR(blocks.fluence[i], together.fluence[i], 0.01 * together.fluence[i]) << albedo;
      }
    }
  }
}

TEST_F(PublishedLattices, RefuseNumbersOutOfRange)
{
  Scene scene({ 3, 3, 3 }, 0.1f, 1.0f);
  const auto refuses = [&](const LatticeSettings& settings, const std::vector<float>& ior, const char* what) {
    const std::string words = ErrorWords([&] { this->Solve(scene, settings, ior); });
    EXPECT_THAT(words, testing::HasSubstr(what));
  };
  LatticeSettings settings;
  settings.blockSize = 9;
  refuses(settings, {}, "BlockSize is 9");
  settings.blockSize = 4;
  settings.stepsPerExchange = 0;
  refuses(settings, {}, "StepsPerExchange is 0");
  settings.stepsPerExchange = 8;
  settings.maximumSteps = -1;
  refuses(settings, {}, "MaximumOrders is -1");
  settings.maximumSteps = 0;
  settings.tolerance = 0.0;
  refuses(settings, {}, "Tolerance is");
  settings.tolerance = 1e-4;
  std::vector<float> ior(27, 1.0f);
  ior[5] = -1.0f;
  refuses(settings, ior, "voxel (2, 1, 0)");
}
