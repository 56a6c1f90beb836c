// What holds for every solver that keeps energy: light propagation maps order by order and accelerated, discrete
// ordinates, and a lattice.

#include "DeviceTest.h"
#include "Difference.h"
#include "LatticeScene.h"
#include "OrdinatesScene.h"

#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <string>

using namespace tyndall;

class EverySolver
  : public DeviceTest
  , public testing::WithParamInterface<const char*>
{
protected:
  LightField Solve(LitMedium scene, double tolerance = 1e-4, const Monitor& monitor = {})
  {
    scene.Attach();
    scene.settings.tolerance = scene.how.tolerance = tolerance;
    scene.how.periodic = scene.settings.periodic;
    scene.how.directionsPerFace = 9;
    if (this->Is("Ordinates"))
    {
      return scene.SolveOrdinates(this->GetDevice(), monitor);
    }
    if (this->Is("Lattice"))
    {
      LatticeSettings settings;
      settings.tolerance = tolerance;
      settings.periodic = scene.settings.periodic;
      return SolveLatticeBoltzmann(
        this->GetDevice(), Domain(scene.medium.grid), scene.medium, {}, scene.light, settings, monitor);
    }
    const bool accelerated = this->Is("Accelerated");
    scene.settings.acceleration = accelerated ? PropagationAcceleration::Automatic : PropagationAcceleration::None;
    scene.settings.source = accelerated ? PropagationSource::Linear : PropagationSource::Constant;
    return scene.Solve(this->GetDevice(), monitor);
  }
  bool Is(const char* name) const { return this->GetParam() == std::string(name); }

  static LitMedium Lit(std::array<int, 3> size, double thickest, double decades, double albedo)
  {
    LitMedium scene(size);
    scene.Randomise(thickest, decades, albedo);
    scene.ShineFromEverywhere(1.0);
    scene.ShineAlong({ 0.3, -0.5, -0.8 }, 2.0);
    return scene;
  }
};

INSTANTIATE_TEST_SUITE_P(Of, EverySolver, testing::Values("Orders", "Accelerated", "Ordinates", "Lattice"),
  [](const auto& info) { return std::string(info.param); });

TEST_P(EverySolver, GivesBackEveryWattItTakes)
{
  for (const double albedo : { 0.0, 0.5, 0.9 })
  {
    for (const double thickest : { 0.0, 1e-4, 1.0, 1e3 })
    {
      for (const bool periodic : { false, true })
      {
        // Rays go round thin boxes many times; a linear source in thick voxels is for those that hardly absorb.
        if ((periodic && thickest < 1.0) || (this->Is("Accelerated") && thickest > 1.0))
        {
          continue;
        }
        LitMedium scene = Lit({ 9, 8, 7 }, thickest, 5.0, albedo);
        scene.emission.assign(scene.sigma_a.size(), 0.0f);
        scene.emission[100] = 3.0f;
        scene.light.faces[0] = { 0.5, 0.5, 0.5 };
        scene.settings.periodic = { periodic, false, false };
        const LightField light = this->Solve(scene);
        EXPECT_LT(light.balance.RelativeError(1), 1e-5) << albedo << ", " << thickest << (periodic ? ", periodic" : "");
        EXPECT_GT(light.balance.entered[0], 0.0);
        for (const float fluence : light.fluence)
        {
          ASSERT_TRUE(std::isfinite(fluence) && fluence >= 0.0f);
        }
      }
    }
  }
}

/// A medium that emits what it absorbs, in a sky as bright: radiance 2 everywhere.
TEST_P(EverySolver, KeepsAFurnaceAtItsTemperature)
{
  for (const double albedo : { 0.0, 0.5, 1.0 })
  {
    if (this->Is("Accelerated") && albedo < 1.0)
    {
      continue; // a linear source is exact for light alone, not for emission
    }
    LitMedium scene({ 10, 11, 9 });
    scene.Randomise(2.0, 4.0, albedo);
    scene.ShineFromEverywhere(2.0);
    scene.emission = scene.sigma_a;
    std::for_each(scene.emission.begin(), scene.emission.end(), [](float& value) { value *= 2.0f; });
    for (const float fluence : this->Solve(scene, 1e-7).fluence)
    {
      ASSERT_NEAR(fluence / (8.0 * Pi), 1.0, this->Is("Lattice") ? 1e-4 : 1e-5) << albedo;
    }
  }
}

TEST_P(EverySolver, SolvesColoursAsItSolvesThemAlone)
{
  const std::array<double, 3> tint = { 1.0, 0.5, 0.2 };
  for (const bool shared : { true, false }) // one extinction for all colours
  {
    LitMedium colour = Lit({ 9, 8, 7 }, 2.0, 2.0, 0.9);
    std::array<LitMedium, 3> alone = { colour, colour, colour };
    const std::size_t voxels = colour.sigma_s.size();
    const std::vector<float> sigma_s = colour.sigma_s, sigma_a = colour.sigma_a;
    colour.sigma_s.resize(3 * voxels);
    colour.sigma_a.resize(3 * voxels);
    for (std::size_t i = 0; i < 3 * voxels; ++i)
    {
      const double scattered = tint[i % 3] * sigma_s[i / 3],
                   both = static_cast<double>(sigma_s[i / 3]) + sigma_a[i / 3];
      alone[i % 3].sigma_s[i / 3] = colour.sigma_s[i] = static_cast<float>(scattered);
      alone[i % 3].sigma_a[i / 3] = colour.sigma_a[i] = shared ? static_cast<float>(both - scattered) : sigma_a[i / 3];
    }
    colour.light.sky = { 1.0, 2.0, 3.0 };
    const LightField together = this->Solve(colour, 1e-6);
    ASSERT_EQ(together.channels, 3);
    for (std::size_t c = 0; c < 3; ++c)
    {
      alone[c].light.sky.fill(1.0 + static_cast<double>(c));
      const LightField one = this->Solve(alone[c], 1e-6);
      for (std::size_t i = 0; i < voxels; ++i)
      {
        ASSERT_NEAR(together.fluence[3 * i + c] / one.fluence[i], 1.0, 1e-4) << c << ", shared " << shared;
      }
      EXPECT_NEAR(together.balance.escaped[c] / one.balance.escaped[0], 1.0, 1e-4) << c;
    }
  }
}

TEST_P(EverySolver, HasNarrowSpotsFarLampsAndDirectionsOfAnyLength)
{
  for (const double length : { 1e-165, 1.0, 1e160 })
  {
    LitMedium scene({ 7, 6, 5 }, 0.05f, 0.2f);
    scene.ShineAlong({ 0.0, 0.6 * length, 0.8 * length });
    Light lamp;
    lamp.type = LightType::Spot;
    lamp.direction = { 0.3 * length, 0.1 * length, length };
    lamp.position = { 3.2, 3.1, -1.0 };
    lamp.angle = 1e-6;
    scene.light.lights.push_back(lamp);
    lamp.type = LightType::Point;
    lamp.position = { 3.2, 1.5e11, -0.5e11 };
    lamp.power = Times(lamp.power, 1e23);
    scene.light.lights.push_back(lamp);
    const LightField light = this->Solve(scene);
    // The sun through two faces, the spot, and the lamp through two.
    const double distance = std::hypot(1.5e11, 0.5e11), irradiance = 1e23 / (4.0 * Pi * distance * distance);
    const double ofLamp = irradiance * (35.0 * 1.5e11 + 42.0 * 0.5e11) / distance;
    EXPECT_NEAR(light.balance.entered[0] / (0.6 * 35.0 + 0.8 * 42.0 + 1.0 + ofLamp), 1.0, 1e-4) << length;
    EXPECT_LT(light.balance.RelativeError(1), 1e-5);
    EXPECT_GE(*std::min_element(light.fluence.begin(), light.fluence.end()), 0.0f);
  }
}

TEST_P(EverySolver, IsTheSameBitForBitTheSecondTime)
{
  const LitMedium scene = Lit({ 20, 17, 15 }, 3.0, 3.0, 0.98);
  const LightField first = this->Solve(scene), again = this->Solve(scene);
  EXPECT_EQ(first.fluence, again.fluence);
  EXPECT_EQ(first.balance.escaped, again.balance.escaped);
}

TEST_P(EverySolver, ReportsProgressThatGrowsAndStopsWhenTold)
{
  const LitMedium scene = Lit({ 12, 9, 10 }, 2.0, 1.0, 0.95);
  double last = 0.0;
  int told = 0;
  this->Solve(scene, 1e-4, [&](double done) {
    EXPECT_GE(done, last - 1e-9);
    EXPECT_LE(done, 1.0 + 1e-9);
    last = done;
    return ++told > 0;
  });
  EXPECT_GT(last, 0.5);
  EXPECT_GT(told, 5);
  const int most = told / 2;
  told = 0;
  EXPECT_THROW(this->Solve(scene, 1e-4, [&](double) { return ++told < most; }), Aborted);
  EXPECT_EQ(told, most);
}
