#include "DeviceTest.h"
#include "Difference.h"
#include "MediumScene.h"

#include "Device/Errors.h"
#include "Light/ChannelReduction.h"
#include "LightPropagation/Accuracy/DirectionForecast.h"
#include "LightPropagation/Accuracy/ResampledScene.h"
#include "LightPropagation/Accuracy/TargetError.h"
#include "LightPropagation/Problem/PropagationQuality.h"

#include <algorithm>
#include <cmath>

using namespace tyndall;

namespace
{
/// A cloud in a box of three different edges under a shining face.
Scene Cloud()
{
  Scene scene({ 22, 15, 18 });
  const std::array<int, 3>& size = scene.medium.grid.size;
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    const std::array<int, 3> at = scene.medium.grid.VoxelAt(i);
    const double wave = std::sin(0.7 * at[0]) * std::cos(0.4 * at[1] + 1.0) * std::sin(0.5 * at[2] + 0.3);
    scene.sigma_s[i] = static_cast<float>(4.0 / size[0] * std::exp(wave));
    scene.sigma_a[i] = 0.1f * scene.sigma_s[i];
  }
  scene.light.faces[2] = { 1.0, 1.0, 1.0 };
  scene.Attach();
  return scene;
}

PropagationSolver SolverOn(Device& device)
{
  return [&device](const SceneBlock& block, const PropagationSettings& settings, const Monitor& monitor) {
    return SolveConservative(device, block.domain, block.medium, block.illumination, settings, monitor);
  };
}

std::vector<float> Exact(Device& device, const Scene& scene)
{
  const Grid& grid = scene.medium.grid;
  const DividedScene divided({ Domain(grid), scene.medium, scene.light }, DividedScene::Halves(grid, {}));
  PropagationSettings settings;
  settings.directionsPerFace = 256;
  settings.uncollidedDirections = 1600;
  settings.staggeredRays = true;
  settings.tolerance = 1e-5;
  LightField light = SolveConservative(device, divided.Scene().medium, divided.Scene().illumination, settings);
  divided.Undo(light);
  return light.fluence;
}
}

class TargetError : public DeviceTest
{
};

TEST_F(TargetError, IsMetByTheTrueError)
{
  const Scene scene = Cloud();
  const std::vector<float> exact = Exact(this->GetDevice(), scene);
  for (const double target : { 0.04, 0.01 })
  {
    const TargetLight found = SolveToTargetError(
      { Domain(scene.medium.grid), scene.medium, scene.light }, {}, target, {}, SolverOn(this->GetDevice()));
    EXPECT_TRUE(found.met) << target;
    EXPECT_TRUE(found.light.doubts.empty());
    EXPECT_LE(found.light.relativeError, target);
    EXPECT_LE(RelativeRmse(found.light.fluence, exact), target);
    EXPECT_EQ(found.light.fluenceError.size(), found.light.fluence.size());
    EXPECT_GE(found.solves, 3);
    EXPECT_GT(found.seconds, 0.0);
  }
}

TEST_F(TargetError, IsRefusedWhereNothingReachesIt)
{
  const Scene scene = Cloud();
  const TargetLight found = SolveToTargetError(
    { Domain(scene.medium.grid), scene.medium, scene.light }, {}, 1e-5, {}, SolverOn(this->GetDevice()));
  EXPECT_FALSE(found.met);
  EXPECT_GT(found.light.relativeError, 1e-5);
  ASSERT_EQ(found.light.doubts.size(), 1u);
  EXPECT_NE(found.light.doubts[0].find("TargetError 1e-05 is not met"), std::string::npos) << found.light.doubts[0];
}

TEST_F(TargetError, DividesVoxelsWhereTheseAreTooCoarse)
{
  Scene scene({ 12, 13, 14 }, 0.06f, 0.24f);
  scene.light.lights.push_back(PointLamp({ 4.3, 8.6, 6.1 }));
  scene.Attach();
  const TargetLight found = SolveToTargetError(
    { Domain(scene.medium.grid), scene.medium, scene.light }, {}, 0.02, {}, SolverOn(this->GetDevice()));
  EXPECT_TRUE(found.divided);
  EXPECT_EQ(found.light.fluence.size(), scene.medium.grid.VoxelCount());
  EXPECT_LT(RelativeRmse(found.light.fluence, Exact(this->GetDevice(), scene)), 0.02);
}

TEST_F(TargetError, IsNotClaimedBesideLampsWhereItIsMissed)
{
  Scene scene({ 21, 26, 18 }, 0.01f, 0.19f);
  for (const std::array<double, 3>& place : { std::array<double, 3>{ 5.2, 17.7, 8.1 }, { 15.6, 30.0, 3.3 } })
  {
    scene.light.lights.push_back(PointLamp(place));
  }
  scene.Attach();
  const std::vector<float> exact = Exact(this->GetDevice(), scene);
  for (const double target : { 0.05, 0.03, 0.02, 0.01 })
  {
    const TargetLight found = SolveToTargetError(
      { Domain(scene.medium.grid), scene.medium, scene.light }, {}, target, {}, SolverOn(this->GetDevice()));
    EXPECT_TRUE(!found.met || RelativeRmse(found.light.fluence, exact) <= target)
      << target << ": " << RelativeRmse(found.light.fluence, exact) << ", estimated " << found.light.relativeError;
  }
}

TEST_F(TargetError, OfColoursIsThatOfEachAlone)
{
  const Scene scene = Cloud();
  Medium medium = scene.medium;
  std::vector<float> sigma_a, sigma_s;
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    for (const float factor : { 1.0f, 0.01f, 8.0f })
    {
      sigma_a.push_back(factor * scene.sigma_a[i]);
      sigma_s.push_back(factor * scene.sigma_s[i]);
    }
  }
  medium.sigma_a = { sigma_a.data(), 3 };
  medium.sigma_s = { sigma_s.data(), 3 };
  Illumination faint = scene.light;
  faint.faces[2] = { 1.0, 1e-3, 1.0 };
  faint.faceAlbedo[4] = { 0.5, 0.25, 0.0 };
  const auto solve = [&](const SceneBlock& block, const Monitor& monitor) {
    TargetLight found = SolveToTargetError(block, {}, 0.03, monitor, SolverOn(this->GetDevice()));
    std::vector<std::string> words = Words(found.settings, found.light);
    return LightOf(std::move(found), std::move(words));
  };
  const Domain domain(medium.grid);
  const LightField all = SolveColours({ domain, medium, faint }, {}, solve);
  double largest = 0.0;
  int solves = 0, known = 0;
  for (int c = 0; c < 3; ++c)
  {
    const OneChannelScene one(medium, faint, c);
    const LightField alone = solve({ domain, one.medium, one.light }, {});
    for (std::size_t i = 0; i < alone.fluence.size(); ++i)
    {
      ASSERT_EQ(all.fluence[3 * i + c], alone.fluence[i]) << c << ", " << i;
    }
    EXPECT_EQ(all.halfRangeFlux[c], alone.halfRangeFlux[0]);
    EXPECT_EQ(all.faceAlbedo[4][c], faint.faceAlbedo[4][c]);
    for (std::size_t i = 0; i < all.facePower.size() / 3; ++i)
    {
      ASSERT_EQ(all.facePower[3 * i + c], alone.facePower.empty() ? 0.0f : alone.facePower[i]) << c << ", " << i;
    }
    for (const auto array : { &LightField::surfaceRadiance, &LightField::surfaceError })
    {
      for (std::size_t i = 0; i < (all.*array).size() / 3; ++i)
      {
        const float value = (all.*array)[3 * i + c];
        ASSERT_TRUE((alone.*array).empty() ? std::isnan(value) : value == (alone.*array)[i]) << c << ", " << i;
      }
    }
    known += alone.surfaceRadiance.empty() ? 0 : 1;
    solves += alone.solves;
    largest = std::max(largest, alone.relativeError);
  }
  EXPECT_FALSE(all.facePower.empty());
  EXPECT_FALSE(all.surfaceRadiance.empty());
  EXPECT_TRUE(known == 1 || known == 2) << known << " colours with surface radiance; some should have none";
  EXPECT_EQ(all.solves, solves);
  EXPECT_EQ(all.relativeError, largest);
  EXPECT_NE(all.settingsUsed[0].find(", "), std::string::npos) << all.settingsUsed[0]; // a number a colour
}

TEST(JoinedChannels, NameColoursThatDiffer)
{
  std::vector<LightField> channels(3);
  channels[0].settingsUsed = { "PolarNodes = 8" };
  channels[1].settingsUsed = { "DirectionsPerFace = 9", "Tolerance = 0.01" };
  channels[2].settingsUsed = { "DirectionsPerFace = 16", "Tolerance = 0.01" };
  channels[0].doubts = { "missed.", "thick." };
  channels[1].doubts = { "thick." };
  channels[2].doubts = { "thick.", "missed." };
  const LightField light = JoinChannels(channels);
  using Texts = std::vector<std::string>;
  EXPECT_EQ(
    light.settingsUsed, (Texts{ "PolarNodes = 8, -, -", "DirectionsPerFace = -, 9, 16", "Tolerance = -, 0.01, 0.01" }));
  EXPECT_EQ(light.doubts, (Texts{ "In red, blue: missed.", "thick." }));
  channels[0].settingsUsed = channels[1].settingsUsed;
  EXPECT_EQ(JoinChannels(channels).settingsUsed, (Texts{ "DirectionsPerFace = 9, 9, 16", "Tolerance = 0.01" }));
}

TEST_F(TargetError, LeavesWhatWasChosen)
{
  const Scene scene = Cloud();
  PropagationSettings chosen;
  chosen.directionsPerFace = 4;
  chosen.uncollidedDirections = 0;
  chosen.tolerance = 0.03;
  const TargetLight found = SolveToTargetError(
    { Domain(scene.medium.grid), scene.medium, scene.light }, chosen, 0.005, {}, SolverOn(this->GetDevice()));
  EXPECT_EQ(found.settings.directionsPerFace, 4);
  EXPECT_EQ(found.settings.uncollidedDirections, 0);
  EXPECT_EQ(found.settings.tolerance, 0.03);
  EXPECT_FALSE(found.met);
}

TEST_F(TargetError, OfLayersIsThatOfTheirCosines)
{
  Scene scene({ 1, 1, 20 }, 0.02f, 0.1f);
  scene.settings.periodic = { true, true, false };
  scene.light.faces[4] = { 1.0, 1.0, 1.0 };
  scene.Attach();
  const TargetLight found = SolveToTargetError(
    { Domain(scene.medium.grid), scene.medium, scene.light }, scene.settings, 0.001, {}, SolverOn(this->GetDevice()));
  EXPECT_TRUE(found.met);
  EXPECT_GT(found.light.polarNodes, 0);
}

TEST_F(TargetError, IsAPartOfOne)
{
  const Scene scene = Cloud();
  for (const double target : { 0.0, -0.1, 1.0, std::nan("") })
  {
    EXPECT_THROW(SolveToTargetError({ Domain(scene.medium.grid), scene.medium, scene.light }, {}, target, {},
                   SolverOn(this->GetDevice())),
      InvalidInput);
  }
}

TEST(DirectionForecast, TellsUnscatteredLightFromTheRest)
{
  LightField few, more;
  more.fluence = { 2.0f, 2.0f };
  more.fluenceDirect = { 1.0f, 1.0f };
  few.fluence = { 2.2f, 1.8f }; // all of the difference is in unscattered light
  few.fluenceDirect = { 1.2f, 0.8f };
  more.convergence.resize(10);
  SingleRank alone;
  DirectionForecast forecast(alone, few, 9, more, 25);
  PropagationSettings settings;
  settings.uncollidedDirections = 400;
  const double fine = forecast.Error(settings);
  settings.uncollidedDirections = 0;
  EXPECT_LT(4.0 * fine, forecast.Error(settings));
  EXPECT_EQ(forecast.Cheapest({}, 1.5 * fine).uncollidedDirections, 0); // what is scattered of it is not known yet
  LightField between = more;
  forecast.Separate(alone, few, between, more);
  const PropagationSettings cheapest = forecast.Cheapest({}, 1.5 * fine);
  EXPECT_LE(cheapest.directionsPerFace, 9);
  EXPECT_GE(cheapest.uncollidedDirections, 256);
  EXPECT_LE(forecast.Error(cheapest), 1.5 * fine);
}
