#include "DeviceTest.h"
#include "RandomMedium.h"
#include "ReflectingScene.h"

#include "Device/Errors.h"
#include "LightPropagation/Published/ParallelPropagation.h"
#include "LightPropagation/Published/SequentialPropagation.h"

#include <gmock/gmock.h>

#include <cstdio>
#include <functional>
#include <string>

using namespace tyndall;
using testing::HasSubstr;

namespace
{
const std::array<Rgb, 6> Walls = { { { 0.3, 0.5, 0.0 }, { 0.9, 0.1, 1.0 }, { 0.0, 0.2, 0.6 }, { 1.0, 1.0, 1.0 },
  { 0.8, 0.7, 0.5 }, { 0.5, 0.5, 0.5 } } };

/// W through a face over those that came in.
double Part(const LightField& light, int face)
{
  return light.facePowerOut[face][0] / light.balance.entered[0];
}

double MeanFluence(const LightField& light)
{
  double sum = 0.0;
  for (float fluence : light.fluence)
  {
    sum += fluence;
  }
  return sum / static_cast<double>(light.fluence.size());
}
}

class PublishedFaceAlbedo : public DeviceTest
{
protected:
  LightField Parallel(Scene& scene, KeptLight* kept = nullptr)
  {
    scene.Attach();
    return SolveParallel(this->GetDevice(), scene.medium, scene.light, scene.settings, {}, 0, kept);
  }

  static LightField Sequential(Scene& scene)
  {
    scene.Attach();
    return SolveSequential(scene.medium, scene.light, scene.settings);
  }

  /// By both algorithms.
  void Solve(Scene& scene, const std::function<void(const LightField&)>& look)
  {
    for (bool sequential : { true, false })
    {
      SCOPED_TRACE(sequential ? "sequential" : "parallel");
      look(sequential ? this->Sequential(scene) : this->Parallel(scene));
    }
  }
};

TEST_F(PublishedFaceAlbedo, KeepsEvenLightEvenWhateverEachFaceGivesBack)
{
  // A medium that absorbs and emits alone, of which the scheme loses nothing.
  const Rgb colour = { 1.0, 0.5, 2.0 };
  for (int directions : { 1, 4, 16, 25 })
  {
    for (int resolution : { 1, 2 })
    {
      Scene scene({ 7, 5, 9 });
      MakeReflectingFurnace(scene, 1.0, 0.0, colour);
      scene.settings.directionsPerFace = directions;
      scene.settings.mapResolution = resolution;
      scene.settings.tolerance = 1e-7;
      this->Solve(scene, [&](const LightField& light) {
        EXPECT_LE(Deviation(light, colour), 2e-5) << directions << ' ' << resolution;
        EXPECT_TRUE(light.converged);
      });
    }
  }
}

TEST_F(PublishedFaceAlbedo, KeepsEvenLightEvenWhereRaysCrossOnTheBorderOfPlanes)
{
  const Rgb white = { 1.0, 1.0, 1.0 };
  Scene scene({ 5, 6, 4 });
  MakeReflectingFurnace(scene, 0.3, 0.0, white);
  scene.medium.grid.spacing = { 1.0, 1.0, 1.0 }; // slopes of 1/4 and 3/4 of a voxel a plane
  scene.settings.directionsPerFace = 16;
  scene.settings.tolerance = 1e-7;
  this->Solve(scene, [&](const LightField& light) { EXPECT_LE(Deviation(light, white), 2e-5); });
}

TEST_F(PublishedFaceAlbedo, LosesNoPowerThatGoesToAndFro)
{
  for (const std::array<bool, 3>& periodic : { std::array{ false, false, false }, { false, true, false } })
  {
    for (int orders : { 1, 2, 5 })
    {
      Scene vacuum({ 6, 4, 7 });
      vacuum.settings.maximumOrders = orders;
      vacuum.settings.periodic = periodic;
      vacuum.light.sky = { 0.3, 0.2, 0.1 };
      vacuum.ShineAlong({ 0.3, -0.5, -1.0 });
      vacuum.light.faceAlbedo = Walls;
      if (periodic[1])
      {
        vacuum.light.faceAlbedo[2] = vacuum.light.faceAlbedo[3] = {};
      }
      this->Solve(vacuum, [&](const LightField& light) {
        EXPECT_LE(light.balance.RelativeError(3), 2e-6) << orders;
        EXPECT_GT(light.balance.leftOver[0], 0.01 * light.balance.entered[0]) << orders;
      });
    }
  }
}

TEST_F(PublishedFaceAlbedo, LetsNothingOutOfAClosedBox)
{
  Scene scene({ 6, 5, 4 }, 0.03f, 0.02f);
  scene.settings.tolerance = 1e-6;
  scene.emission.assign(scene.sigma_a.size(), 0.0f);
  scene.emission[17] = 1.0f;
  scene.light.faceAlbedo.fill(Grey(1.0));
  this->Solve(scene, [&](const LightField& light) {
    const EnergyBalance& balance = light.balance;
    EXPECT_NEAR(balance.escaped[0], 0.0, 1e-5 * balance.emitted[0]);
    // The scheme loses to voxels what Eq. (14) says: given / lost = exp(-tau), of 0.05 times some 1.2.
    EXPECT_NEAR(balance.absorbed[0] / balance.emitted[0], 1.0, 0.08);
    EXPECT_TRUE(light.converged);
    std::printf("closed box: absorbed %.4f of emitted, %zu orders\n", balance.absorbed[0] / balance.emitted[0],
      light.convergence.size());
  });
}

TEST_F(PublishedFaceAlbedo, IsTheGeometricSeriesOfTheSameScheme)
{
  // Ground of one cell: what shines from it spreads as FaceRadiance does, and of that the scheme says what comes back.
  for (int face : { 4, 5, 0, 3 })
  {
    std::array<int, 3> size = { 1, 1, 1 };
    size[face / 2] = 6;
    Scene scene(size, 0.05f, 0.3f);
    scene.settings.tolerance = 1e-9;
    scene.light.faces[face ^ 1] = Grey(1.0);
    this->Solve(scene, [&](const LightField& fromAbove) {
      Scene below = scene;
      below.light.faces = {};
      below.light.faces[face] = Grey(1.0);
      const LightField fromGround = this->Parallel(below);
      for (double albedo : { 0.3, 0.8, 1.0 })
      {
        Scene ground = scene;
        ground.light.faceAlbedo[face] = Grey(albedo);
        const LightField light = this->Parallel(ground);
        const double falls = Part(fromAbove, face) / (1.0 - albedo * Part(fromGround, face));
        for (int other = 0; other < 6; ++other)
        {
          const double reflected = Part(fromAbove, other) + albedo * falls * Part(fromGround, other);
          const double expected = other == face ? (1.0 - albedo) * falls : reflected;
          EXPECT_NEAR(Part(light, other), expected, 2e-6) << face << ' ' << albedo << ' ' << other;
        }
        const double entered = light.balance.entered[0] / fromGround.balance.entered[0];
        for (std::size_t i = 0; i < light.fluence.size(); ++i)
        {
          const double sum = fromAbove.fluence[i] + albedo * falls * entered * fromGround.fluence[i];
          EXPECT_NEAR(light.fluence[i], sum, 2e-6 * sum) << face << ' ' << albedo << ' ' << i;
        }
      }
    });
  }
}

TEST_F(PublishedFaceAlbedo, IsTheSameByBothAlgorithms)
{
  for (int variant = 0; variant < 5; ++variant)
  {
    SCOPED_TRACE(variant);
    RandomMedium random(Grid{ { 9, 6, 7 }, { 1.0, 0.6, 1.7 } }, variant % 2 ? 3 : 1, 0.5f);
    random.Emit(0.2f);
    Illumination light;
    light.sky = { 0.1, 0.2, 0.4 };
    light.faces[2] = { 1.0, 0.5, 0.1 };
    Light sun;
    sun.direction = { 1.0, 0.4, -0.2 };
    sun.power = { 3.0, 2.0, 1.0 };
    light.lights.push_back(sun);
    light.faceAlbedo = Walls;
    PropagationSettings settings;
    settings.maximumOrders = 4;
    settings.directionsPerFace = variant < 2 ? 16 : 25;
    settings.mapResolution = variant == 2 ? 2 : 1;
    settings.netFlux = true;
    settings.periodic = { false, variant == 3, variant == 4 };
    for (int axis = 1; axis < 3; ++axis)
    {
      if (settings.periodic[axis])
      {
        light.faceAlbedo[2 * axis] = light.faceAlbedo[2 * axis + 1] = {};
      }
    }
    const LightField parallel = SolveParallel(this->GetDevice(), random.medium, light, settings);
    const LightField batches = SolveParallel(this->GetDevice(), random.medium, light, settings, {}, 1);
    const LightField sequential = SolveSequential(random.medium, light, settings);
    EXPECT_LT(RelativeRmse(parallel.fluence, sequential.fluence), 1e-5);
    EXPECT_LT(RelativeRmse(parallel.fluenceDirect, sequential.fluenceDirect), 1e-5);
    EXPECT_LT(RelativeRmse(parallel.scatteredRadiance, sequential.scatteredRadiance), 1e-5);
    EXPECT_LT(RelativeRmse(parallel.netFlux, sequential.netFlux), 1e-5);
    EXPECT_LT(RelativeRmse(parallel.facePower, sequential.facePower), 1e-5);
    EXPECT_LT(RelativeRmse(batches.fluence, parallel.fluence), 1e-7); // which sums of doubles come first
    for (int c = 0; c < 3; ++c)
    {
      const double all = sequential.balance.entered[c] + sequential.balance.emitted[c];
      EXPECT_NEAR(parallel.balance.leftOver[c], sequential.balance.leftOver[c], 1e-5 * all);
      EXPECT_NEAR(parallel.balance.escaped[c], sequential.balance.escaped[c], 1e-5 * all);
    }
  }
}

TEST_F(PublishedFaceAlbedo, TurnsWithTheScene)
{
  const int n = 6;
  RandomMedium random({ n, n, n });
  Illumination light;
  light.sky = Grey(0.4);
  light.faces[5] = Grey(2.0);
  for (int face = 0; face < 6; ++face)
  {
    light.faceAlbedo[face] = Grey(0.15 * (face + 1));
  }
  PropagationSettings settings;
  settings.maximumOrders = 4;
  const LightField original = SolveParallel(this->GetDevice(), random.medium, light, settings);
  const auto turned = [&](auto place, std::array<int, 6> faceFrom) {
    RandomMedium other({ n, n, n });
    Illumination illumination = light;
    std::vector<float> expected(original.fluence.size());
    for (int i = 0; i < n * n * n; ++i)
    {
      const int to = place(i % n, i / n % n, i / n / n);
      other.absorption[to] = random.absorption[i];
      other.scattering[to] = random.scattering[i];
      expected[to] = original.fluence[i];
    }
    for (int face = 0; face < 6; ++face)
    {
      illumination.faces[face] = light.faces[faceFrom[face]];
      illumination.faceAlbedo[face] = light.faceAlbedo[faceFrom[face]];
    }
    const LightField found = SolveParallel(this->GetDevice(), other.medium, illumination, settings);
    EXPECT_LT(RelativeRmse(found.fluence, expected), 1e-6);
    for (int face = 0; face < 6; ++face)
    {
      EXPECT_NEAR(found.facePowerOut[face][0], original.facePowerOut[faceFrom[face]][0], 1e-4);
    }
  };
  turned([&](int x, int y, int z) { return (z * n + x) * n + y; }, { 2, 3, 0, 1, 4, 5 });
  turned([&](int x, int y, int z) { return (x * n + z) * n + y; }, { 2, 3, 4, 5, 0, 1 });
  turned([&](int x, int y, int z) { return (z * n + y) * n + n - 1 - x; }, { 1, 0, 2, 3, 4, 5 });
  turned([&](int x, int y, int z) { return ((n - 1 - z) * n + y) * n + x; }, { 0, 1, 2, 3, 5, 4 });
}

TEST_F(PublishedFaceAlbedo, TellsWhatLeavesEveryCell)
{
  Scene scene({ 8, 6, 5 });
  scene.Randomise(0.5, 2.0, 0.7);
  scene.light.sky = { 0.3, 0.2, 0.1 };
  scene.ShineAlong({ 0.3, -0.5, -1.0 });
  scene.light.faceAlbedo[1] = { 0.5, 0.4, 0.3 };
  scene.light.faceAlbedo[4] = Grey(0.8);
  this->Solve(scene, [&](const LightField& light) {
    ASSERT_EQ(light.facePower.size(), 3 * BoxFaceCellCount(scene.medium.grid));
    EXPECT_EQ(light.faceAlbedo, scene.light.faceAlbedo);
    for (int face = 0; face < 6; ++face)
    {
      for (int c = 0; c < 3; ++c)
      {
        const double kept = 1.0 - scene.light.faceAlbedo[face][c];
        EXPECT_NEAR(kept * Leaving(light, scene.medium.grid, face, c), light.facePowerOut[face][c],
          2e-6 * light.balance.entered[0])
          << face << ' ' << c;
      }
    }
  });
  scene.light.faceAlbedo = {};
  this->Solve(scene, [](const LightField& light) { EXPECT_TRUE(light.facePower.empty()); });
}

TEST_F(PublishedFaceAlbedo, IsGroundAsTheConservativeSchemeHasIt)
{
  // Voxels of 0.0125 mean free paths, of which the published scheme loses little.
  for (int axis : { 2, 0 })
  {
    for (double cosine : { 0.0, 1.0 })
    {
      std::array<int, 3> size = { 6, 6, 6 };
      size[axis] = 40;
      Scene scene(size, 0.00125f, 0.01125f);
      scene.settings.periodic = { axis != 0, axis != 1, axis != 2 };
      scene.settings.tolerance = 1e-3;
      std::array<double, 3> down = {};
      down[axis] = -1.0;
      cosine > 0.0 ? scene.ShineAlong(down) : static_cast<void>(scene.light.faces[2 * axis + 1] = Grey(1.0));
      for (double ground : axis == 2 ? std::vector<double>{ 0.3, 0.8, 1.0 } : std::vector<double>{ 0.8 })
      {
        scene.light.faceAlbedo[2 * axis] = Grey(ground);
        const LightField found = this->Parallel(scene), truth = scene.Solve(this->GetDevice());
        std::printf(
          "axis %d, cosine %g, ground %g: reflected %.4f (conservative %.4f), taken %.4f (%.4f), balance %.2g\n", axis,
          cosine, ground, Part(found, 2 * axis + 1), Part(truth, 2 * axis + 1), Part(found, 2 * axis),
          Part(truth, 2 * axis), found.balance.RelativeError(1));
        EXPECT_NEAR(Part(found, 2 * axis + 1), Part(truth, 2 * axis + 1), 0.01);
        EXPECT_NEAR(Part(found, 2 * axis), Part(truth, 2 * axis), 0.01);
        EXPECT_TRUE(found.converged);
      }
    }
  }
}

TEST_F(PublishedFaceAlbedo, IsNotConvergedBeforeLightHasComeBack)
{
  // Between a face that gives back all and one that gives back little orders fall by nothing and by much in turn.
  for (int dull : { 4, 5 })
  {
    Scene vacuum({ 4, 4, 3 });
    vacuum.settings.periodic = { true, true, false };
    vacuum.settings.directionsPerFace = 1; // none goes round sideways
    vacuum.light.faces[5] = Grey(1.0);
    vacuum.light.faceAlbedo[dull] = Grey(0.01);
    vacuum.light.faceAlbedo[9 - dull] = Grey(0.99);
    this->Solve(vacuum, [&](const LightField& light) {
      // 1 comes down, of which the lower face gives back a part, and the upper a part of that.
      const double low = vacuum.light.faceAlbedo[4][0];
      EXPECT_NEAR(MeanFluence(light), 4.0 * Pi / 6.0 * (1.0 + low) / (1.0 - 0.0099), 1e-4 * MeanFluence(light)) << dull;
      EXPECT_TRUE(light.converged);
    });
  }
}

TEST_F(PublishedFaceAlbedo, SaysThatABoxThatHardlyAbsorbsDoesNotEnd)
{
  Scene scene({ 2, 2, 2 }, 1e-6f, 0.01f);
  scene.settings.directionsPerFace = 1;
  scene.light.faceAlbedo.fill(Grey(1.0));
  scene.emission.assign(scene.sigma_a.size(), 1.0f);
  const LightField light = this->Sequential(scene);
  EXPECT_FALSE(light.converged);
  EXPECT_FALSE(light.doubts.empty());
}

TEST_F(PublishedFaceAlbedo, IsTheSameFromTheLastLight)
{
  for (double scattering : { 0.02, 0.3 })
  {
    Scene scene({ 7, 5, 6 }, 0.02f, static_cast<float>(scattering));
    scene.settings.tolerance = 1e-5;
    scene.ShineAlong({ 0.3, -0.2, -1.0 });
    scene.light.faceAlbedo[4] = Grey(0.8);
    scene.light.faceAlbedo[1] = Grey(0.4);
    KeptLight kept;
    this->Parallel(scene, &kept);
    EXPECT_EQ(this->Parallel(scene, &kept).convergence.size(), 2u) << "nothing changed";
    scene.sigma_s[30] *= 1.5f;
    scene.light.faceAlbedo[4] = Grey(0.78);
    const LightField warm = this->Parallel(scene, &kept), cold = this->Parallel(scene);
    std::printf("scattering %g: %zu orders from the last light, %zu from the dark, difference %.2g\n", scattering,
      warm.convergence.size(), cold.convergence.size(), RelativeRmse(warm.fluence, cold.fluence));
    EXPECT_LE(RelativeRmse(warm.fluence, cold.fluence), 2e-5);
    EXPECT_TRUE(warm.converged);
    EXPECT_LT(warm.convergence.size(), cold.convergence.size());
    EXPECT_NEAR(warm.facePowerOut[4][0], cold.facePowerOut[4][0], 2e-5 * cold.balance.entered[0]);
    EXPECT_LE(RelativeRmse(warm.facePower, cold.facePower), 5e-5);
  }
}

TEST_F(PublishedFaceAlbedo, KeepsColoursApart)
{
  Scene scene({ 5, 6, 4 }, 0.05f, 0.2f);
  scene.light.sky = { 0.5, 1.0, 0.25 };
  scene.light.faceAlbedo[4] = { 0.9, 0.5, 0.0 };
  const LightField light = this->Parallel(scene);
  ASSERT_EQ(light.channels, 3);
  for (int c = 0; c < 3; ++c)
  {
    Scene one = scene;
    one.light.sky = Grey(scene.light.sky[c]);
    one.light.faceAlbedo[4] = Grey(scene.light.faceAlbedo[4][c]);
    one.settings.maximumOrders = static_cast<int>(light.convergence.size());
    const LightField alone = this->Parallel(one);
    ASSERT_EQ(alone.channels, 1);
    for (std::size_t i = 0; i < alone.fluence.size(); ++i)
    {
      EXPECT_NEAR(light.fluence[3 * i + c], alone.fluence[i], 1e-5 * alone.fluence[i]);
    }
    EXPECT_NEAR(light.facePowerOut[4][c], alone.facePowerOut[4][0], 1e-5 * alone.balance.entered[0]);
  }
}

TEST_F(PublishedFaceAlbedo, IsLookedAt)
{
  Scene scene({ 3, 3, 3 }, 0.1f, 0.1f);
  scene.light.sky = Grey(1.0);
  const auto says = [&] {
    try
    {
      this->Parallel(scene);
    }
    catch (const InvalidInput& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  scene.light.faceAlbedo[2] = Grey(0.5);
  EXPECT_EQ(says(), "");
  scene.settings.periodic = { false, true, false };
  EXPECT_THAT(says(), HasSubstr("periodic"));
  scene.settings.periodic = {};
  scene.light.faceAlbedo.fill(Grey(1.0));
  scene.sigma_a.assign(scene.sigma_a.size(), 0.0f);
  EXPECT_THAT(says(), HasSubstr("without end"));
}
