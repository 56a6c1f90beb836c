#include "DeviceTest.h"
#include "Medium/Grid.h"
#include "OrdinatesScene.h"

#include "Device/Errors.h"
#include "DiscreteOrdinates/OrdinatesError.h"
#include "LatticeBoltzmann/DiffusionError.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "Medium/BoxFaces.h"
#include "Medium/Coarsening.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
constexpr int Voxels = 24; ///< an axis

/// sigma_t at places in the unit cube.
Scene Cube(double albedo, const std::function<double(double, double, double)>& opticalThickness)
{
  Scene scene({ Voxels, Voxels, Voxels });
  ForGridVoxels({ Voxels, Voxels, Voxels }, [&](std::size_t i, int x, int y, int z) {
    const double sigma_t = opticalThickness((x + 0.5) / Voxels, (y + 0.5) / Voxels, (z + 0.5) / Voxels) / Voxels;
    scene.sigma_s[i] = static_cast<float>(albedo * sigma_t);
    scene.sigma_a[i] = static_cast<float>((1.0 - albedo) * sigma_t);
  });
  return scene;
}

double RadiusSquared(double x, double y, double z)
{
  return (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5) + (z - 0.5) * (z - 0.5);
}

/// The same medium in voxels of half the edge.
Scene Finer(const Scene& scene)
{
  const Grid& grid = scene.medium.grid;
  Scene fine({ 2 * grid.size[0], 2 * grid.size[1], 2 * grid.size[2] });
  fine.medium.grid.spacing = { 0.5 * grid.spacing[0], 0.5 * grid.spacing[1], 0.5 * grid.spacing[2] };
  fine.light = scene.light;
  fine.settings = scene.settings;
  const Coarsening back(fine.medium.grid);
  const auto copy = [&](const std::vector<float>& from, std::vector<float>& to) {
    to.resize(from.empty() ? 0 : fine.medium.grid.VoxelCount());
    for (std::size_t i = 0; i < to.size(); ++i)
    {
      to[i] = from[back.Parent(i)];
    }
  };
  copy(scene.sigma_a, fine.sigma_a);
  copy(scene.sigma_s, fine.sigma_s);
  copy(scene.emission, fine.emission);
  return fine;
}

LightField Estimate(Device& device, Scene& scene)
{
  scene.Solve(device); // lets the medium see its arrays
  return SolveWithErrorEstimate({ Domain(scene.medium.grid), scene.medium, scene.light }, scene.settings, {},
    [&](const SceneBlock& block, const PropagationSettings& settings, const Monitor& monitor) {
      return SolveConservative(device, block.domain, block.medium, block.illumination, settings, monitor);
    });
}
}

class ErrorEstimate : public DeviceTest
{
protected:
  /// Of a solve with half the voxel and six times the directions; those of light from outside, of which there may be
  /// more in what is judged, are more again.
  void ExpectHonest(Scene scene, const char* name)
  {
    this->ExpectHonest(Estimate(this->GetDevice(), scene), scene, name);
  }

  /// @param leastWithin  part of the voxels whose error is below the estimate, at least
  void ExpectHonest(const LightField& light, const Scene& scene, const char* name, double leastWithin = 0.65)
  {
    Scene fine = Finer(scene);
    fine.settings.directionsPerFace = 144;
    fine.settings.uncollidedDirections = 900;
    fine.settings.tolerance = 1e-5;
    const std::vector<float> exact =
      Coarsening(fine.medium.grid).Average(fine.Solve(this->GetDevice()).fluence.data(), 1);
    double errors = 0.0, fluences = 0.0;
    int within = 0, withinTwo = 0;
    for (std::size_t i = 0; i < exact.size(); ++i)
    {
      const double error = std::abs(static_cast<double>(light.fluence[i]) - exact[i]);
      errors += error * error;
      fluences += static_cast<double>(exact[i]) * exact[i];
      within += error <= light.fluenceError[i];
      withinTwo += error <= 2.0 * light.fluenceError[i];
    }
    const double ratio = light.relativeError / std::sqrt(errors / fluences);
    const double part = static_cast<double>(within) / exact.size();
    const double partOfTwo = static_cast<double>(withinTwo) / exact.size();
    EXPECT_GT(ratio, 0.5) << name;
    EXPECT_LT(ratio, 2.5) << name;
    EXPECT_GT(part, leastWithin) << name;
    EXPECT_GT(partOfTwo, 0.9) << name;
    this->RecordProperty(name,
      "true " + std::to_string(std::sqrt(errors / fluences)) + ", estimate over it " + std::to_string(ratio) +
        ", within one " + std::to_string(part) + ", two " + std::to_string(partOfTwo));
  }
};

TEST_F(ErrorEstimate, IsNearTheTrueErrorOfACubeUnderAShiningFace)
{
  for (double tau : { 0.3, 5.0, 100.0 })
  {
    Scene scene = Cube(tau > 50.0 ? 1.0 : 0.9, [&](double, double, double) { return tau; });
    scene.light.faces[4] = { 1.0, 1.0, 1.0 };
    this->ExpectHonest(scene, ("tau " + std::to_string(static_cast<int>(tau))).c_str());
  }
}

TEST_F(ErrorEstimate, IsNearTheTrueErrorOfACloudInTheSun)
{
  Scene scene = Cube(0.999, [](double x, double y, double z) {
    return 30.0 * std::max(0.0, 1.0 - 6.0 * RadiusSquared(x, y, z)) *
      (1.0 + 0.5 * std::sin(20.0 * x) * std::sin(17.0 * y + 1.0) * std::sin(14.0 * z));
  });
  scene.ShineFromEverywhere(0.1);
  scene.ShineAlong({ 0.3, 0.5, -1.0 });
  this->ExpectHonest(scene, "cloud");
}

TEST_F(ErrorEstimate, IsNearTheTrueErrorOfABallInHaze)
{
  Scene scene = Cube(0.9, [](double x, double y, double z) { return RadiusSquared(x, y, z) < 0.09 ? 20.0 : 0.4; });
  scene.ShineFromEverywhere(0.1);
  scene.ShineAlong({ 0.3, 0.5, -1.0 });
  this->ExpectHonest(scene, "ball");
}

TEST_F(ErrorEstimate, SeesTheRaysOfALampInTheFog)
{
  Scene scene = Cube(0.8, [](double, double, double) { return 4.0; });
  Light lamp;
  lamp.type = LightType::Point;
  lamp.position = { 7.8, 9.6, 15.1 };
  scene.light.lights.push_back(lamp);
  this->ExpectHonest(scene, "lamp");
}

/// Discrete ordinates have errors of another order in space, and of their own directions.
TEST_F(ErrorEstimate, IsNearTheTrueErrorOfOrdinates)
{
  Scene scenes[] = { Cube(0.9, [](double, double, double) { return 5.0; }),
    Cube(0.9, [](double x, double y, double z) { return RadiusSquared(x, y, z) < 0.09 ? 20.0 : 0.4; }) };
  scenes[0].light.faces[4] = { 1.0, 1.0, 1.0 };
  scenes[1].ShineFromEverywhere(0.1);
  scenes[1].ShineAlong({ 0.3, 0.5, -1.0 });
  for (Scene& scene : scenes)
  {
    scene.Attach();
    const LightField light =
      EstimateOrdinates(this->GetDevice(), { Domain(scene.medium.grid), scene.medium, scene.light }, {});
    this->ExpectHonest(light, scene, &scene == scenes ? "cube by ordinates" : "ball by ordinates", 0.5);
  }
}

TEST_F(ErrorEstimate, OfOrdinatesIsATargetThatAThinBoxUnderAShiningFaceMeets)
{
  LitMedium empty({ 16, 16, 16 }, 1e-6f, 1e-6f);
  empty.light.faces[4] = { 1.0, 1.0, 1.0 };
  empty.Attach();
  const LightField light = SolveOrdinatesToTarget(
    this->GetDevice(), { Domain(empty.medium.grid), empty.medium, empty.light }, empty.how, 0.02);
  EXPECT_LE(light.relativeError, 0.02);
  EXPECT_LE(ErrorInEmptyCube(light.fluence, empty.medium.grid), 0.02);
}

/// The lattice has the error of diffusion, large in a thin cube and small in a thick one.
TEST_F(ErrorEstimate, IsNearTheTrueErrorOfDiffusion)
{
  for (const double tau : { 1.0, 20.0 })
  {
    Scene scene = Cube(0.95, [&](double, double, double) { return tau; });
    scene.light.faces[4] = { 1.0, 1.0, 1.0 };
    scene.ShineAlong({ 0.3, 0.5, -1.0 });
    scene.Attach();
    const SceneBlock block = { Domain(scene.medium.grid), scene.medium, scene.light };
    LightField light = SolveLatticeBoltzmann(this->GetDevice(), block.domain, scene.medium, {}, scene.light, {});
    EstimateDiffusionError(this->GetDevice(), block, {}, false, {}, light);
    EXPECT_EQ(light.relativeError > 0.1, tau < 5.0) << light.relativeError;
    JudgeTarget(1.01 * light.relativeError, light);
    EXPECT_TRUE(light.doubts.empty());
    JudgeTarget(0.5 * light.relativeError, light);
    EXPECT_EQ(light.doubts.size(), 1u);
    this->ExpectHonest(light, scene, tau < 5.0 ? "thin lattice" : "thick lattice", 0.5);
  }
}

TEST_F(ErrorEstimate, IsNotMadeOfSchemesAsPublished)
{
  Scene scene = Cube(0.9, [](double, double, double) { return 5.0; });
  scene.Attach();
  OrdinatesSettings published;
  published.scheme = OrdinatesScheme::Published;
  EXPECT_THROW(
    EstimateOrdinates(this->GetDevice(), { Domain(scene.medium.grid), scene.medium, scene.light }, published),
    InvalidInput);
}

TEST_F(ErrorEstimate, CountsTheOrdersThatWereNotComputed)
{
  Scene scene = Cube(0.99, [](double, double, double) { return 20.0; });
  scene.ShineFromEverywhere(1.0);
  const double whole = Estimate(this->GetDevice(), scene).relativeError;
  scene.settings.maximumOrders = 2;
  const LightField light = Estimate(this->GetDevice(), scene);
  EXPECT_GT(light.relativeError, 5.0 * whole);
  EXPECT_GE(light.relativeError, light.convergence.back().residual);
}

TEST_F(ErrorEstimate, LeavesTheLightAsItIs)
{
  Scene scene({ 9, 1, 6 });
  scene.Randomise(3.0, 2.0, 0.9);
  scene.ShineFromEverywhere(1.0);
  const LightField light = Estimate(this->GetDevice(), scene);
  EXPECT_EQ(light.fluence, scene.Solve(this->GetDevice()).fluence);
  EXPECT_EQ(light.fluenceError.size(), light.fluence.size());
  EXPECT_GT(light.relativeError, 0.0);
}

TEST_F(ErrorEstimate, OfEachColourIsThatOfItsLightAlone)
{
  Scene grey({ 12, 10, 8 });
  grey.Randomise(3.0, 2.0, 0.9);
  grey.ShineFromEverywhere(1.0);
  Scene coloured = grey;
  coloured.light.sky = { 1.0, 0.0, 2.0 };
  const LightField one = Estimate(this->GetDevice(), grey);
  const LightField three = Estimate(this->GetDevice(), coloured);
  ASSERT_EQ(three.fluenceError.size(), 3 * one.fluenceError.size());
  for (std::size_t i = 0; i < one.fluenceError.size(); ++i)
  {
    ASSERT_NEAR(three.fluenceError[3 * i], one.fluenceError[i], 1e-4 * one.fluence[i]);
    ASSERT_EQ(three.fluenceError[3 * i + 1], 0.0f);
    ASSERT_NEAR(three.fluenceError[3 * i + 2], 2.0f * one.fluenceError[i], 2e-4 * one.fluence[i]);
  }
}

TEST_F(ErrorEstimate, HasTheLengthOverWhichItsSignIsTheSame)
{
  const Domain domain(Grid{ { 16, 16, 16 }, { 1.0, 2.0, 4.0 } });
  const CoarseBlocks blocks(domain.Comm(), domain.Partition());
  // Errors of one sign in `run` coarse voxels of an edge of 2, 4 and 8, and then of the other.
  const auto length = [&](int run) {
    LightField light;
    ForGridVoxels({ 16, 16, 16 }, [&](std::size_t, int x, int y, int z) {
      light.fluence.push_back((x / 2 / run + y / 2 / run + z / 2 / run) % 2 == 0 ? 1.0f : -1.0f);
    });
    const std::vector<float> coarse(8 * 8 * 8, 0.0f);
    WriteErrorEstimate(light, blocks, coarse, coarse, 1.0, 2.0);
    return light.errorLength;
  };
  EXPECT_NEAR(length(1), 4.0, 1e-9);
  EXPECT_NEAR(length(2), 4.0 * (8.0 / 7.0) / (6.0 / 7.0), 1e-9); // r = (4 - 3) / 7
  EXPECT_GT(length(8), 100.0);
}

TEST_F(ErrorEstimate, OfRadianceThatLeavesThickVoxelsIsHonest)
{
  for (const bool sun : { true, false })
  {
    Scene scene({ 16, 16, 16 }, 0.04f, 3.96f);
    scene.light.faces[2] = { 1.0, 1.0, 1.0 };
    if (sun)
    {
      scene.light = {};
      scene.light.lights = { PointLamp({ 5.0, -30.0, 9.0 }) };
    }
    const LightField light = Estimate(this->GetDevice(), scene);
    ASSERT_EQ(light.surfaceError.size(), light.surfaceRadiance.size());
    Scene fine = Finer(Finer(scene));
    for (std::vector<float>* sigma : { &fine.sigma_a, &fine.sigma_s })
    {
      sigma->assign(fine.medium.grid.VoxelCount(), sigma->front());
    }
    fine.settings.tolerance = 1e-5;
    const std::vector<float> exact = fine.Solve(this->GetDevice()).surfaceRadiance;
    std::vector<double> means(light.surfaceRadiance.size());
    ForBoxFaceCells(fine.medium.grid, [&](const BoxFaceCell& cell) {
      const std::size_t parent = 256 * cell.face + 16 * (cell.v / 4) + cell.u / 4;
      for (std::size_t k = 0; k < 4; ++k)
      {
        means[4 * parent + k] += exact[4 * cell.number + k] / 16.0;
      }
    });
    double errors = 0.0, estimates = 0.0, within = 0.0;
    for (std::size_t i = 0; i < means.size(); ++i)
    {
      const double error = light.surfaceRadiance[i] - means[i], estimate = light.surfaceError[i];
      errors += error * error;
      estimates += estimate * estimate;
      within += std::abs(error) <= 2.0 * estimate ? 1.0 : 0.0;
    }
    EXPECT_GT(std::sqrt(estimates / errors), 0.5) << sun;
    EXPECT_LT(std::sqrt(estimates / errors), 2.0) << sun;
    EXPECT_GT(within / static_cast<double>(means.size()), 0.9) << sun;
  }
}

TEST_F(ErrorEstimate, IsNotKnownAfterOneOrder)
{
  Scene scene = Cube(0.9, [](double, double, double) { return 5.0; });
  scene.ShineFromEverywhere(1.0);
  scene.settings.maximumOrders = 1;
  const LightField one = Estimate(this->GetDevice(), scene);
  EXPECT_TRUE(std::isnan(one.relativeError)) << one.relativeError;
  EXPECT_TRUE(one.fluenceError.empty());
  ASSERT_EQ(one.convergence.size(), 1u);
  EXPECT_EQ(one.convergence[0].residual, 1.0);
  scene.settings.maximumOrders = 2;
  const LightField two = Estimate(this->GetDevice(), scene);
  EXPECT_GT(two.relativeError, 0.1);
  EXPECT_LT(two.relativeError, 20.0);
}

TEST(Coarsening, KeepsTheSumOfOddGrids)
{
  Grid grid;
  grid.size = { 7, 1, 4 };
  grid.spacing = { 0.5, 1.0, 2.0 };
  const Coarsening coarsening(grid);
  EXPECT_EQ(coarsening.Coarse().size, (std::array<int, 3>{ 3, 1, 2 }));
  EXPECT_DOUBLE_EQ(coarsening.Coarse().Length(0), grid.Length(0));
  EXPECT_DOUBLE_EQ(coarsening.Ratio(), 2.0);
  std::vector<float> values(2 * grid.VoxelCount());
  std::array<double, 2> sum = {}, after = {};
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = static_cast<float>(i * i % 17);
    sum[i % 2] += values[i];
  }
  const std::vector<float> means = coarsening.Average(values.data(), 2);
  ASSERT_EQ(means.size(), 12u);
  for (std::size_t i = 0; i < means.size(); ++i)
  {
    after[i % 2] += means[i] * 28.0 / 6.0;
  }
  EXPECT_NEAR(after[0], sum[0], 1e-4);
  EXPECT_NEAR(after[1], sum[1], 1e-4);
  EXPECT_NEAR(means[0],
    (values[0] + values[2] + values[4] / 3.0 + values[14] + values[16] + values[18] / 3.0) / (14.0 / 3.0), 1e-5);
}

TEST(Coarsening, PutsEveryVoxelIntoTheOneAroundItsCentre)
{
  Grid grid;
  grid.size = { 7, 1, 4 };
  const Coarsening coarsening(grid);
  EXPECT_EQ(coarsening.Parent(0), 0u);
  EXPECT_EQ(coarsening.Parent(3), 1u);
  EXPECT_EQ(coarsening.Parent(6), 2u);
  EXPECT_EQ(coarsening.Parent(2 * 7 + 2), 3u + 1u);
}
