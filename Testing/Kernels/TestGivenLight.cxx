#include "CubeTurns.h"
#include "DeviceTest.h"
#include "Difference.h"
#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "ErrorWords.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "LightPropagation/Published/ParallelPropagation.h"
#include "LightPropagation/Published/SequentialPropagation.h"
#include "LightPropagation/Uncollided/GivenLight.h"
#include "MediumScene.h"
#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Marching/PhotonMarcher.h"

#include <functional>
#include <string>

using namespace tyndall;

namespace
{
using Solver = std::function<LightField(const Medium&, const Illumination&)>;

/// Uncollided light of a beam in a medium, by rays of its own.
struct Beam
{
  std::vector<float> fluence, direction;
  std::array<Rgb, 6> escaped = {};
  Rgb entered = {};

  UncollidedImage Image() const
  {
    const auto voxels = static_cast<int>(this->direction.size() / 3);
    UncollidedImage image;
    image.fluence = { this->fluence.data(), static_cast<int>(this->fluence.size()) / voxels };
    image.meanDirection = { this->direction.data(), 3 };
    image.escaped = this->escaped;
    return image;
  }
};

constexpr std::array<double, 3> Slanting = { 0.36, -0.48, 0.8 };

/// A medium of random densities, not a cube, under a slanting sun.
Scene RandomScene(double g)
{
  Scene scene({ 14, 11, 9 });
  scene.medium.grid.spacing = { 0.1, 0.12, 0.13 };
  scene.Randomise(0.6, 2.0, 0.95, 20261123);
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
  scene.settings.directionsPerFace = 64;
  return scene;
}

Beam FindBeam(Device& device, Scene scene, const Rgb& power)
{
  scene.medium.phase = PhaseFunction();
  scene.light = {};
  scene.ShineAlong(Slanting);
  scene.light.lights.back().power = power;
  scene.settings.maximumOrders = 1;
  const LightField light = scene.Solve(device);
  Beam beam;
  beam.fluence = light.fluenceDirect;
  for (std::size_t i = 0; i < scene.medium.grid.VoxelCount(); ++i)
  {
    beam.direction.insert(beam.direction.end(), { 0.36f, -0.48f, 0.8f });
  }
  beam.escaped = light.facePowerOut;
  beam.entered = light.balance.entered;
  return beam;
}
}

class GivenLightTest : public DeviceTest
{
protected:
  std::vector<std::pair<std::string, Solver>> Solvers(const PropagationSettings& settings)
  {
    PropagationSettings accelerated = settings, published = settings;
    accelerated.source = PropagationSource::Linear;
    published.directionsPerFace = 16;
    OrdinatesSettings ordinates;
    ordinates.directionsPerFace = 16;
    Device& device = this->GetDevice();
    return {
      { "orders",
        [=, &device](const Medium& m, const Illumination& l) { return SolveConservative(device, m, l, settings); } },
      { "accelerated",
        [=, &device](const Medium& m, const Illumination& l) { return SolveConservative(device, m, l, accelerated); } },
      { "ordinates",
        [=, &device](const Medium& m, const Illumination& l) {
          return SolveDiscreteOrdinates(device, Domain(m.grid), m, l, ordinates);
        } },
      { "published",
        [=, &device](const Medium& m, const Illumination& l) { return SolveParallel(device, m, l, published); } },
      { "sequential", [=](const Medium& m, const Illumination& l) { return SolveSequential(m, l, published); } },
    };
  }

  void ExpectWhatALampGives(const std::vector<double>& cosines)
  {
    for (const double g : cosines)
    {
      Scene scene = RandomScene(g);
      scene.ShineAlong(Slanting);
      scene.Attach();
      const Beam beam = FindBeam(this->GetDevice(), scene, { 1.0, 1.0, 1.0 });
      Illumination given;
      given.uncollided = beam.Image();
      for (const auto& [name, solve] : this->Solvers(scene.settings))
      {
        if (name == "published" || name == "sequential")
        {
          continue; // a beam comes in along one direction of theirs
        }
        const LightField ofLamp = solve(scene.medium, scene.light), found = solve(scene.medium, given);
        const double most = g == 0.0 ? 1e-6 : g == 0.5 ? 3e-3 : 0.015; // moments of the peak that goes on
        EXPECT_LT(SumOfDifferences(found.fluence, ofLamp.fluence), most) << name << " g " << g;
        EXPECT_EQ(found.fluenceDirect.size(), ofLamp.fluenceDirect.size());
      }
    }
  }
};

TEST_F(GivenLightTest, OfALampGivesWhatTheLampGives)
{
  this->ExpectWhatALampGives({ 0.0, 0.85 });
}

TEST_F(GivenLightTest, NightlyOfALampGivesWhatTheLampGives)
{
  this->ExpectWhatALampGives({ 0.5 });
}

TEST_F(GivenLightTest, LosesNoPower)
{
  for (const double g : { -0.4, 0.0, 0.7 })
  {
    Scene scene = RandomScene(g);
    scene.Attach();
    const Beam beam = FindBeam(this->GetDevice(), scene, { 1.0, 1.0, 1.0 });
    Illumination given;
    given.uncollided = beam.Image();
    for (const auto& [name, solve] : this->Solvers(scene.settings))
    {
      const LightField found = solve(scene.medium, given);
      if (name == "published" || name == "sequential") // which loses power by itself
      {
        EXPECT_NEAR(found.balance.entered[0], beam.entered[0], 1e-5 * beam.entered[0]) << name << " g " << g;
        continue;
      }
      EXPECT_NEAR(found.balance.entered[0], beam.entered[0], 1e-5 * beam.entered[0]) << name << " g " << g;
      EXPECT_LT(found.balance.RelativeError(found.channels), 1e-5) << name << " g " << g;
      const float least = *std::min_element(found.fluence.begin(), found.fluence.end());
      EXPECT_GE(least, 0.0f) << name << " g " << g;
    }
  }
}

TEST_F(GivenLightTest, IsUncollidedLightAsItIs)
{
  Scene scene = RandomScene(0.0);
  scene.Attach();
  const Beam beam = FindBeam(this->GetDevice(), scene, { 1.0, 1.0, 1.0 });
  Illumination given;
  given.uncollided = beam.Image();
  for (const auto& [name, solve] : this->Solvers(scene.settings))
  {
    EXPECT_LT(RelativeDifference(solve(scene.medium, given).fluenceDirect, beam.fluence), 1e-6) << name;
  }
}

TEST_F(GivenLightTest, HasColour)
{
  Scene scene = RandomScene(0.0);
  scene.Attach();
  const Beam one = FindBeam(this->GetDevice(), scene, { 1.0, 1.0, 1.0 });
  Beam coloured = one;
  coloured.fluence.clear();
  for (float value : one.fluence)
  {
    coloured.fluence.insert(coloured.fluence.end(), { value, 0.5f * value, 0.0f });
  }
  for (Rgb& face : coloured.escaped)
  {
    face = { face[0], 0.5 * face[0], 0.0 };
  }
  Illumination white, red;
  white.uncollided = one.Image();
  red.uncollided = coloured.Image();
  for (const auto& [name, solve] : this->Solvers(scene.settings))
  {
    const LightField grey = solve(scene.medium, white), found = solve(scene.medium, red);
    ASSERT_EQ(grey.channels, 1) << name;
    ASSERT_EQ(found.channels, 3) << name;
    std::vector<float> expected;
    for (float value : grey.fluence)
    {
      expected.insert(expected.end(), { value, 0.5f * value, 0.0f });
    }
    EXPECT_LT(RelativeDifference(found.fluence, expected), 1e-5) << name;
    EXPECT_NEAR(found.balance.entered[1], 0.5 * grey.balance.entered[0], 1e-6 * grey.balance.entered[0]) << name;
  }
}

TEST_F(GivenLightTest, IsLinearAndAddsUpInAnyUnit)
{
  Scene scene = RandomScene(0.5);
  scene.Attach();
  Beam beam = FindBeam(this->GetDevice(), scene, { 1.0, 1.0, 1.0 });
  Illumination given;
  given.uncollided = beam.Image();
  const LightField one = SolveConservative(this->GetDevice(), scene.medium, given, scene.settings);
  for (float& value : beam.fluence)
  {
    value *= 1e25f;
  }
  for (Rgb& face : beam.escaped)
  {
    face = Times(face, 1e25);
  }
  given.uncollided = beam.Image();
  const LightField bright = SolveConservative(this->GetDevice(), scene.medium, given, scene.settings);
  std::vector<float> scaled = bright.fluence;
  std::for_each(scaled.begin(), scaled.end(), [](float& value) { value *= 1e-25f; });
  EXPECT_LT(RelativeDifference(scaled, one.fluence), 1e-5);
  EXPECT_NEAR(bright.balance.entered[0] * 1e-25, one.balance.entered[0], 1e-5 * one.balance.entered[0]);
}

TEST_F(GivenLightTest, HasItsErrorEstimated)
{
  Scene scene = RandomScene(0.5);
  scene.Attach();
  const Beam beam = FindBeam(this->GetDevice(), scene, { 1.0, 1.0, 1.0 });
  Illumination given;
  given.uncollided = beam.Image();
  const LightField light = SolveWithErrorEstimate({ Domain(scene.medium.grid), scene.medium, given }, scene.settings,
    {}, [&](const SceneBlock& block, const PropagationSettings& how, const Monitor& monitor) {
      return SolveConservative(this->GetDevice(), block.domain, block.medium, block.illumination, how, monitor);
    });
  EXPECT_EQ(light.fluenceError.size(), light.fluence.size());
  EXPECT_GT(light.relativeError, 1e-4);
  EXPECT_LT(light.relativeError, 0.05);
}

/// Photons through a lens of fog, handed on: what they lost is what the maps scatter and absorb.
TEST_F(GivenLightTest, OfPhotonsConservesTheirPower)
{
  Scene scene = RandomScene(0.0);
  scene.ShineAlong(Slanting, 2.0);
  scene.Attach();
  EmissionSettings emission;
  emission.photonCount = 200000;
  const std::vector<Photon> photons = EmitPhotons(scene.medium.grid, scene.light, emission).photons;
  MarchSettings march;
  march.meanDirection = true;
  const PhotonLight marched =
    PhotonMarcher(this->GetDevice(), Domain(scene.medium.grid), scene.medium, {}, march).March(photons);
  Illumination given;
  given.uncollided.fluence = { marched.light.fluence.data(), marched.light.channels };
  given.uncollided.meanDirection = { marched.meanDirection.data(), 3 };
  given.uncollided.escaped = marched.light.facePowerOut;
  const LightField found = SolveConservative(this->GetDevice(), scene.medium, given, scene.settings);
  EXPECT_NEAR(found.balance.entered[0], marched.light.balance.entered[0], 1e-5 * found.balance.entered[0]);
  EXPECT_LT(found.balance.RelativeError(found.channels), 1e-5);
  const LightField ofLamp = scene.Solve(this->GetDevice());
  EXPECT_LT(SumOfDifferences(found.fluence, ofLamp.fluence), 0.01);
}

TEST_F(GivenLightTest, RefusesWhatIsNoLight)
{
  Scene scene = RandomScene(0.0);
  scene.Attach();
  Beam beam = FindBeam(this->GetDevice(), scene, { 1.0, 1.0, 1.0 });
  const auto error = [&] {
    Illumination given;
    given.uncollided = beam.Image();
    return ErrorWords([&] { SolveConservative(this->GetDevice(), scene.medium, given, scene.settings); });
  };
  beam.fluence[15] = -1.0f;
  EXPECT_NE(error().find("voxel (1, 1, 0)"), std::string::npos) << error();
  beam.fluence[15] = 1.0f;
  beam.direction[3 * 15] = 2.0f;
  EXPECT_NE(error().find("mean_direction"), std::string::npos) << error();
}

TEST(SmoothPeak, IsNowhereNegative)
{
  EXPECT_NEAR(SmoothPeak(1), 1.0 / 3.0, 1e-6); // 1 + 3 m cos
  EXPECT_GT(SmoothPeak(5), SmoothPeak(3));
  EXPECT_LT(SmoothPeak(9), 1.0);
}
