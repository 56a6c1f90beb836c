// Light that diffuses on a lattice.

#include "Difference.h"
#include "ErrorWords.h"
#include "LatticeScene.h"

#include "Numerics/Constants.h"
#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Marching/PhotonMarcher.h"
#include "Reference/SlabReference.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace tyndall;

class LatticeBoltzmann : public LatticeTest
{
};

/// Light that began at times 0 to T has spread by D T in the mean, along each axis: 2 D t averaged. A step takes as
/// long as light needs for an edge.
TEST_F(LatticeBoltzmann, SpreadsAsDiffusionSays)
{
  for (const int directions : { 6, 18 })
  {
    for (const double thickness : { 0.7, 4.0, 12.0 })
    {
      LatticeSettings settings;
      settings.directions = directions;
      const std::array<double, 4> growth = this->GrowthOver(1.0 / (3.0 * thickness), settings, thickness);
      for (int a = 0; a < 4; ++a)
      {
        EXPECT_NEAR(growth[a], 1.0, 0.01) << directions << " directions, thickness " << thickness << ", axis " << a;
      }
    }
  }
}

TEST_F(LatticeBoltzmann, FindsTheSquareOfTheIndexInAFurnace)
{
  Scene scene({ 9, 8, 7 });
  scene.Randomise(3.0, 2.0, 1.0, 5);
  scene.ShineFromEverywhere(1.0);
  std::vector<float> ior;
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    const double x = i % 9 - 4.0, y = i / 9 % 8 - 3.5, z = i / 72 - 3.0;
    ior.push_back(std::hypot(x, y, z) < 2.6 ? 2.4f : 1.0f);
  }
  LatticeSettings settings;
  settings.tolerance = 1e-7;
  const LightField light = this->Solve(scene, settings, ior);
  for (std::size_t i = 0; i < ior.size(); ++i)
  {
    ASSERT_NEAR(light.fluence[i] / (4.0 * Pi * ior[i] * ior[i]), 1.0, 1e-4) << i;
  }
}

/// A slab of albedo 1 under diffuse light: diffusion's own transmittance, 1 / (1 + 3 tau / 4).
TEST_F(LatticeBoltzmann, TransmitsASlabAsDiffusionDoes)
{
  for (const double tau : { 1.0, 4.0, 40.0 })
  {
    Scene scene({ 1, 1, 20 }, 0.0f, static_cast<float>(tau / 20.0));
    scene.light.faces[4] = { 1.0, 1.0, 1.0 };
    LatticeSettings settings;
    settings.periodic = { true, true, false };
    settings.tolerance = 1e-6;
    const LightField light = this->Solve(scene, settings);
    const double transmitted = light.facePowerOut[5][0] / light.balance.entered[0];
    EXPECT_NEAR(transmitted * (1.0 + 0.75 * tau), 1.0, 0.02) << tau;
    EXPECT_LT(std::abs(light.balance.leftOver[0]), 1e-4 * light.balance.entered[0]) << tau;
  }
}

/// A beam into a white slab of thick voxels, along each axis and askew: what it transmits is in proportion to how deep
/// light is first scattered, and much too much if that were in the middle of the first voxel.
TEST_F(LatticeBoltzmann, BeginsWhereABeamIsFirstScattered)
{
  constexpr int Layers = 12;
  for (const double thickness : { 0.7, 2.0, 5.0, 30.0 })
  {
    for (const double cosine : { 1.0, 0.5 })
    {
      const int axis = thickness < 1.0 ? 0 : thickness < 3.0 ? 1 : 2;
      Scene scene({ 1, 1, 1 }, 0.0f, static_cast<float>(thickness));
      scene.medium.grid.size[axis] = Layers;
      scene.sigma_a.assign(Layers, 0.0f);
      scene.sigma_s.assign(Layers, static_cast<float>(thickness));
      std::array<double, 3> direction = {};
      direction[(axis + 1) % 3] = std::sqrt(1.0 - cosine * cosine);
      direction[axis] = -cosine;
      scene.ShineAlong(direction);
      LatticeSettings settings;
      settings.periodic = { axis != 0, axis != 1, axis != 2 };
      const LightField light = this->Solve(scene, settings);
      const double transmitted = light.facePowerOut[2 * axis][0] / light.balance.entered[0];
      const double expected = ThickSlabBeamTransmittance(thickness * Layers, cosine);
      EXPECT_NEAR(transmitted / expected, 1.0, 0.02) << thickness << " " << cosine;
      EXPECT_LT(light.balance.RelativeError(1), 1e-6);
      EXPECT_LT(std::abs(light.balance.leftOver[0]), 1e-5 * light.balance.entered[0]);
      // Handed on by voxel, it is known by its direction and by how it falls off.
      std::vector<float> along;
      for (int i = 0; i < 3 * Layers; ++i)
      {
        along.push_back(static_cast<float>(direction[i % 3]));
      }
      Scene again = scene;
      again.light = {};
      again.light.uncollided.fluence = { light.fluenceDirect.data(), light.channels };
      again.light.uncollided.meanDirection = { along.data(), 3 };
      const LightField given = this->Solve(again, settings);
      const double through = given.facePowerOut[2 * axis][0] / given.balance.entered[0];
      EXPECT_NEAR(through / expected, 1.0, 0.02) << thickness << " " << cosine;
    }
  }
}

/// In rough media with shadows where a voxel's light is lost is not told by its neighbours as well as by its rays, but
/// better than by nothing: against photons that are scattered until they end.
TEST_F(LatticeBoltzmann, GuessesWhereLightThatIsHandedOnIsFirstScattered)
{
  const std::array<double, 3> direction = { -0.48, 0.36, -0.8 };
  for (const double decades : { 0.5, 1.5 })
  {
    Scene scene({ 9, 8, 10 });
    scene.Randomise(8.0, decades, 0.99, 20261123);
    scene.ShineAlong(direction);
    const LightField own = this->Solve(scene);
    MarchSettings all;
    all.maximumOrders = 0;
    const PhotonLight truth =
      PhotonMarcher(this->GetDevice(), Domain(scene.medium.grid), scene.medium, {}, all)
        .March(EmitPhotons(scene.medium.grid, scene.light, { 400000, Sampler::Hammersley, 1 }).photons);
    scene.light = {};
    scene.light.uncollided.fluence = { own.fluenceDirect.data(), own.channels };
    const LightField middle = this->Solve(scene);
    std::vector<float> along;
    for (std::size_t i = 0; i < 3 * own.fluence.size(); ++i)
    {
      along.push_back(static_cast<float>(direction[i % 3]));
    }
    scene.light.uncollided.meanDirection = { along.data(), 3 };
    const LightField given = this->Solve(scene);
    const auto off = [&](const LightField& light) { return SumOfDifferences(light.fluence, truth.light.fluence); };
    EXPECT_LT(off(own), 0.15) << decades;
    EXPECT_LT(off(given), 0.25) << decades;
    EXPECT_LT(off(given), 0.5 * off(middle)) << decades;
    EXPECT_LT(std::abs(given.balance.leftOver[0]), 1e-5 * given.balance.entered[0]);
  }
}

/// Of thick voxels that absorb, too, by adding and doubling.
TEST_F(LatticeBoltzmann, ReflectsABeamAsSlabsOfThickVoxelsDo)
{
  for (const double albedo : { 0.9, 0.99 })
  {
    const SlabReference slab = SlabOf(10.0, albedo);
    Scene scene({ 1, 5, 1 }, static_cast<float>(2.0 * (1.0 - albedo)), static_cast<float>(2.0 * albedo));
    scene.ShineAlong({ 0.0, 1.0, 0.0 });
    LatticeSettings settings;
    settings.periodic = { true, false, true };
    const LightField light = this->Solve(scene, settings);
    const double reflected = light.facePowerOut[2][0] / light.balance.entered[0];
    EXPECT_NEAR(reflected, slab.beamR, 0.01) << albedo;
  }
}

/// Light is nowhere negative, and none is lost, where a lamp's light comes into corners and goes from thick to thin.
TEST_F(LatticeBoltzmann, KeepsPowerOfBeamsIntoThickVoxelsOfEveryKind)
{
  for (const double albedo : { 0.3, 0.999, 1.0 })
  {
    Scene scene({ 6, 5, 7 });
    scene.Randomise(1e3, 6.0, albedo, 20261123);
    scene.ShineAlong({ -0.5, 0.7, 0.5 });
    scene.light.faceAlbedo[4] = { 0.6, 0.6, 0.6 };
    LatticeSettings settings;
    settings.netFlux = true;
    const LightField light = this->Solve(scene, settings);
    for (std::size_t i = 0; i < light.fluence.size(); ++i)
    {
      ASSERT_TRUE(std::isfinite(light.fluence[i]) && light.fluence[i] >= 0.0f) << albedo;
      const float* flux = light.netFlux.data() + 3 * i;
      // Links along diagonals are longer than 1.
      ASSERT_LE(std::hypot(flux[0], flux[1], flux[2]), std::sqrt(2.0) * light.fluence[i]) << albedo << " " << i;
    }
    EXPECT_LT(std::abs(light.balance.leftOver[0]), 1e-5 * light.balance.entered[0]) << albedo;
  }
}

/// Sums of lights that come into thick voxels from different sides, each brighter near another face.
TEST_F(LatticeBoltzmann, AddsUpLightsInThickVoxels)
{
  for (const double albedo : { 0.5, 0.9 })
  {
    Scene dark({ 7, 8, 6 });
    dark.Randomise(8.0, 1.0, albedo, 20261129);
    LatticeSettings settings;
    settings.tolerance = 1e-7;
    settings.netFlux = true;
    const auto solve = [&](bool sun, bool other, bool lamp) {
      Scene scene = dark;
      if (sun)
      {
        scene.ShineAlong({ 0.4, -0.3, -0.8 }, 2.0);
      }
      if (other)
      {
        scene.ShineAlong({ -0.9, 0.05, 0.2 }, 1.3);
      }
      if (lamp)
      {
        scene.light.lights.push_back(PointLamp({ 2.3, 9.0, 4.4 }, { 30.0, 30.0, 30.0 }));
      }
      return this->Solve(scene, settings);
    };
    const LightField all = solve(true, true, true);
    const std::array<LightField, 3> each = { solve(true, false, false), solve(false, true, false),
      solve(false, false, true) };
    const double largest = *std::max_element(all.fluence.begin(), all.fluence.end());
    for (std::size_t i = 0; i < all.fluence.size(); ++i)
    {
      const double sum = each[0].fluence[i] + each[1].fluence[i] + each[2].fluence[i];
      ASSERT_NEAR(all.fluence[i], sum, 1e-5 * largest) << albedo << ' ' << i;
      for (std::size_t a = 3 * i; a < 3 * i + 3; ++a)
      {
        const double flux = each[0].netFlux[a] + each[1].netFlux[a] + each[2].netFlux[a];
        ASSERT_NEAR(all.netFlux[a], flux, 1e-5 * largest) << albedo << ' ' << i;
      }
    }
  }
}

/// A channel's powers are those of a solve of that channel alone, where a lamp and photons are white and the sky is
/// not.
TEST_F(LatticeBoltzmann, CountsThePowerOfEachChannelOfWhiteLightBesideColour)
{
  Photon photon;
  photon.position = { 3.5, 4.2, 0.0 };
  photon.power = { 0.2f, 0.2f, 0.2f };
  const std::vector<Photon> photons(100, photon);
  for (const bool marches : { false, true })
  {
    Scene scene({ 7, 8, 6 });
    scene.Randomise(1.0, 2.0, 0.9, 20261129);
    const auto solve = [&](const Rgb& sky) {
      scene.light.sky = sky;
      scene.Attach();
      return marches ? SolveLatticeBoltzmann(this->GetDevice(), Domain(scene.medium.grid), scene.medium, {}, photons,
                         scene.light, LatticeSettings())
                     : this->Solve(scene);
    };
    if (!marches)
    {
      scene.ShineAlong({ 0.4, -0.3, -0.8 }, 2.0);
    }
    const Rgb sky = { 0.1, 0.2, 0.3 };
    const LightField light = solve(sky);
    for (std::size_t c = 0; c < 3; ++c)
    {
      const LightField one = solve({ sky[c], sky[c], sky[c] });
      const double entered = one.balance.entered[0];
      EXPECT_NEAR(light.balance.entered[c], entered, 1e-6 * entered) << marches << c;
      for (std::size_t face = 0; face < 6; ++face)
      {
        EXPECT_NEAR(light.facePowerOut[face][c], one.facePowerOut[face][0], 1e-5 * entered) << marches << c << face;
      }
    }
  }
}

TEST_F(LatticeBoltzmann, IsPositiveAndKeepsPowerWhateverItsVoxelsAre)
{
  for (const double albedo : { 0.0, 0.5, 0.999, 1.0 })
  {
    Scene scene({ 8, 7, 9 });
    scene.Randomise(1e4, 8.0, albedo, 20261123);
    scene.ShineAlong({ 0.3, -0.2, -0.9 });
    scene.ShineFromEverywhere(0.3);
    LatticeSettings settings;
    settings.maximumSteps = 3000;
    const LightField light = this->Solve(scene, settings);
    for (float fluence : light.fluence)
    {
      ASSERT_TRUE(std::isfinite(fluence) && fluence >= 0.0f) << albedo;
    }
    EXPECT_LT(light.balance.RelativeError(1), 1e-7); // what is left over closes it, but for uncollided light's rounding
    EXPECT_GT(light.balance.leftOver[0], -1e-3 * light.balance.entered[0]) << albedo;
    EXPECT_LT(light.balance.leftOver[0], (albedo < 0.9 ? 1e-3 : 0.5) * light.balance.entered[0]) << albedo;
  }
}

/// Large lattices are written past caches, in other steps of memory than small ones.
TEST_F(LatticeBoltzmann, IsTheSameInLargeBoxesAsInTheOneThatTheyRepeat)
{
  const std::array<int, 3> small = { 30, 21, 35 };
  const std::array<int, 3> large = { 90, 63, 70 };
  LatticeSettings settings;
  settings.periodic = { true, true, true };
  settings.maximumSteps = 3;
  std::mt19937 random(20261123);
  std::uniform_real_distribution<float> any(0.0f, 2.0f);
  Scene one(small, 0.1f, 1.0f), many(large, 0.1f, 1.0f);
  one.emission.assign(one.sigma_s.size(), 0.0f);
  std::generate(one.emission.begin(), one.emission.end(), [&] { return any(random); });
  many.emission.assign(many.sigma_s.size(), 0.0f);
  const auto same = [&](std::size_t i) {
    const std::size_t x = i % large[0] % small[0], y = i / large[0] % large[1] % small[1],
                      z = i / large[0] / large[1] % small[2];
    return (z * small[1] + y) * small[0] + x;
  };
  for (std::size_t i = 0; i < many.emission.size(); ++i)
  {
    many.emission[i] = one.emission[same(i)];
  }
  const LightField of_one = this->Solve(one, settings), of_many = this->Solve(many, settings);
  std::size_t others = 0;
  for (std::size_t i = 0; i < of_many.fluence.size(); ++i)
  {
    others += of_many.fluence[i] != of_one.fluence[same(i)];
  }
  EXPECT_EQ(others, 0u);
  EXPECT_GT(of_one.fluence[0], 0.0f);
}

TEST_F(LatticeBoltzmann, TakesAllLightOfALampInABoxWithoutFaces)
{
  for (const float sigma_t : { 0.2f, 0.3f, 0.4f, 0.5f }) // of which the first pass takes nearly all
  {
    Scene scene({ 6, 6, 9 }, 0.1f * sigma_t, 0.9f * sigma_t);
    scene.light.lights = { PointLamp({ 1.8, 3.6, 4.1 }, { 1.0, 1.0, 1.0 }) };
    LatticeSettings settings;
    settings.periodic = { true, true, true };
    const LightField light = this->Solve(scene, settings);
    EXPECT_NEAR(light.balance.entered[0], 1.0, 1e-5) << sigma_t;
    EXPECT_NEAR(light.balance.absorbed[0], 1.0, 2e-4) << sigma_t;
  }
}

/// A ground of albedo A under a slab that absorbs nothing: T (1 - A) / (1 - A R) of the diffuse light is lost to it.
TEST_F(LatticeBoltzmann, GivesBackWhatTheGroundDoes)
{
  Scene scene({ 1, 1, 16 }, 0.0f, 0.25f);
  scene.light.faces[5] = { 1.0, 1.0, 1.0 };
  LatticeSettings settings;
  settings.periodic = { true, true, false };
  settings.tolerance = 1e-6;
  const LightField black = this->Solve(scene, settings);
  scene.light.faceAlbedo[4] = { 0.8, 0.8, 0.8 };
  const LightField snow = this->Solve(scene, settings);
  const double entered = black.balance.entered[0], through = black.facePowerOut[4][0] / entered;
  const double back = black.facePowerOut[5][0] / entered;
  EXPECT_NEAR(through + back, 1.0, 1e-4);
  EXPECT_NEAR(snow.facePowerOut[4][0] / entered, 0.2 * through / (1.0 - 0.8 * back), 0.01);
  EXPECT_LT(std::abs(snow.balance.leftOver[0]), 1e-4 * entered);
}

/// In thick voxels a lamp's own light is first scattered where it comes in, light that is handed on in the middle.
TEST_F(LatticeBoltzmann, TakesUncollidedLightOfAnotherSolver)
{
  Scene scene({ 8, 7, 9 }, 0.01f, 0.08f);
  scene.ShineAlong({ 0.3, -0.2, -0.9 });
  const LightField own = this->Solve(scene);
  Scene again = scene;
  again.light = {};
  again.light.uncollided.fluence = { own.fluenceDirect.data(), own.channels };
  const LightField given = this->Solve(again);
  EXPECT_LT(RelativeDifference(given.fluence, own.fluence), 1e-6);
}

TEST_F(LatticeBoltzmann, RefusesWhatItCannotDo)
{
  Scene scene({ 3, 3, 3 }, 0.1f, 1.0f);
  LatticeSettings settings;
  settings.directions = 26;
  EXPECT_THROW(this->Solve(scene, settings), InvalidInput);
  scene.medium.grid.spacing = { 1.0, 1.0, 2.0 };
  const std::string words = ErrorWords([&] { this->Solve(scene); });
  EXPECT_THAT(words, testing::HasSubstr("cubes"));
}
