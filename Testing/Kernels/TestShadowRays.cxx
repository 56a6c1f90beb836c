#include "ViewScene.h"

#include <numeric>

using namespace tyndall;
using namespace viewing;

namespace
{
class ShadowRays : public DeviceTest
{
};

// Light from above through a slab that is looked at from above: J = E exp(-sigma z) p, seen through exp(-sigma z).
TEST_F(ShadowRays, ScatterOnceAsTheClosedFormSays)
{
  for (double g : { 0.0, 0.6, -0.4 })
  {
    for (int components : { 1, 3 })
    {
      Scene scene(GridOf(6, 6, 64));
      const double sigma_a = 0.01;
      const double sigma_s = 0.03;
      scene.components = components;
      scene.sigma_a.assign(components * scene.grid.VoxelCount(), static_cast<float>(sigma_a));
      scene.sigma_s.assign(components * scene.grid.VoxelCount(), static_cast<float>(sigma_s));
      scene.g = g;
      Light sun;
      sun.direction = { 0.0, 0.0, -2.0 };
      sun.power = { 1.0, 2.0, 3.0 };
      scene.illumination.lights = { sun };
      scene.settings.shadowRays = true;
      const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 10.0));
      const double sigma = sigma_a + sigma_s;
      const double phase = (1.0 - g * g) / (4.0 * Pi * std::pow(1.0 + g, 3.0)); // straight back
      const double expected = sigma_s * phase * -std::expm1(-2.0 * sigma * 64.0) / (2.0 * sigma);
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_NEAR(expected * (c + 1), picture.radiance[3 * Middle(picture) + c], 5e-4 * expected * (c + 1)) << g;
      }
    }
  }
}

// What the sun sends through thin haze is scattered by the phase function, of each channel and voxel.
TEST_F(ShadowRays, ScatterByThePhaseFunctionOfTheMedium)
{
  const std::array<PhaseFunction, 3> coloured = { PhaseFunction::HenyeyGreenstein(0.3), PhaseFunction::Rayleigh(),
    PhaseFunction::DoubleHenyeyGreenstein(0.7, -0.5, 0.6) };
  const PhaseFunction table = PhaseFunction::Tabulated({ -1.0, -0.5, 0.5, 1.0 }, { 2.0, 1.0, 3.0, 20.0 });
  const std::vector<float> g(3 * 8 * 8 * 8, 0.6f);
  for (const PhaseOfMedium& phase : { PhaseOfMedium(coloured), PhaseOfMedium(coloured[2]),
         PhaseOfMedium(PhaseFunction::Rayleigh()), PhaseOfMedium(PhaseFunction::Schlick(0.8)), PhaseOfMedium(table),
         PhaseOfMedium(PhaseFunction::Schlick(0.0), Field{ g.data(), 1 }),
         PhaseOfMedium(PhaseFunction::HenyeyGreenstein(0.0), Field{ g.data(), 3 }) })
  {
    for (const Vec& travels : { Vec{ 0.0, 0.0, -1.0 }, Vec{ 0.8, 0.0, 0.6 }, Vec{ 0.6, 0.8, 0.0 } })
    {
      Scene scene(GridOf(8, 8, 8));
      scene.sigma_s = scene.Everywhere(1e-6);
      scene.phase = phase;
      Light sun;
      sun.direction = travels;
      sun.power = { 1e6 / 8.0, 1e6 / 8.0, 1e6 / 8.0 };
      scene.illumination.lights = { sun };
      scene.settings.shadowRays = true;
      const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 10.0));
      for (int c = 0; c < 3; ++c)
      {
        const double expected = phase.At(0, c).Value(travels[2]); // seen from above, light leaves upwards
        EXPECT_NEAR(picture.radiance[3 * Middle(picture) + c], expected, 2e-4 * expected) << c << " " << travels[2];
      }
    }
  }
}

// A sky lights the medium, no lamp and no sun does: asked for or not, the same picture of the same arrays, and it is
// said.
TEST_F(ShadowRays, AreLeftOutWhereNoLampShines)
{
  for (bool single : { false, true })
  {
    Scene scene = Blobs();
    scene.g = 0.7;
    scene.fluenceDirect = scene.Everywhere(0.3);
    scene.meanDirection = Random(3 * scene.grid.VoxelCount(), 0.5f, 8);
    scene.settings.singleScatteringOnly = single;
    scene.illumination.lights.resize(1);
    scene.illumination.lights[0].power = { 0.0, 0.0, 0.0 }; // a lamp that is off
    const auto seen = [&](bool shadowRays, std::size_t* bytes, std::string* words) {
      scene.settings.shadowRays = shadowRays;
      this->GetDevice().ResetPeak();
      MediumRayCaster caster = scene.Caster(this->GetDevice());
      const Picture picture = caster.Render(scene.Framed());
      *bytes = this->GetDevice().PeakBytes();
      for (const std::string& text : caster.LeftOut())
      {
        *words += text + "\n";
      }
      return picture;
    };
    std::size_t without = 0, with = 0;
    std::string unasked, asked;
    const Picture plain = seen(false, &without, &unasked);
    const Picture same = seen(true, &with, &asked);
    EXPECT_EQ(plain.radiance, same.radiance) << single;
    EXPECT_EQ(plain.alpha, same.alpha);
    EXPECT_EQ(plain.depth, same.depth);
    EXPECT_EQ(without, with) << "bytes on the device";
    EXPECT_NE(std::string::npos, unasked.find("shadow rays: not asked for")) << unasked;
    EXPECT_NE(std::string::npos, asked.find("shadow rays: no lamp and no sun shines")) << asked;

    // A caster that is there serves both.
    scene.settings.shadowRays = false;
    MediumRayCaster kept = scene.Caster(this->GetDevice());
    kept.Render(scene.Framed());
    scene.settings.shadowRays = true;
    EXPECT_TRUE(kept.Adopt(scene.settings));
    EXPECT_EQ(plain.radiance, kept.Render(scene.Framed()).radiance);
  }
}

// What shadow rays lose on their way does not depend on how many steps that is made of.
TEST_F(ShadowRays, VerySmallStepsLoseWhatTheyShould)
{
  Scene scene(GridOf(3, 3, 400));
  scene.settings.imageSize = { 5, 5 };
  const double sigma = 1.2 / 400.0;
  scene.sigma_a = scene.Everywhere(0.5 * sigma);
  scene.sigma_s = scene.Everywhere(0.5 * sigma);
  Light sun;
  sun.direction = { 0.0, 0.0, -1.0 };
  scene.illumination.lights = { sun };
  scene.settings.shadowRays = true;
  const double expected = 0.5 * sigma / (4.0 * Pi) * -std::expm1(-2.0 * sigma * 400.0) / (2.0 * sigma);
  for (double step : { 1.0, 0.01 })
  {
    scene.settings.stepSize = step;
    const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 10.0));
    EXPECT_NEAR(expected, picture.radiance[3 * Middle(picture)], 2e-5 * expected) << step;
  }
}

TEST_F(ShadowRays, FarLightsOfEveryKindLookAlike)
{
  Scene scene = Blobs();
  scene.fluence.clear();
  scene.g = 0.3;
  scene.settings.shadowRays = true;
  const Vec centre = { 25.0, 20.5, 18.5 };
  const double r = 1e4;
  const Vec direction = { -0.6, 0.0, -0.8 };
  Light light;
  light.direction = direction;
  for (int axis = 0; axis < 3; ++axis)
  {
    light.position[axis] = centre[axis] - r * direction[axis];
  }
  light.angle = 2.0;
  light.size = { 3.0, 5.0 };
  const auto seenBy = [&](LightType type, double power) {
    light.type = type;
    light.power = { power, power, power };
    scene.illumination.lights = { light };
    return scene.Seen(this->GetDevice()).radiance;
  };
  const std::vector<float> sun = seenBy(LightType::Directional, 10.0);
  EXPECT_GT(*std::max_element(sun.begin(), sun.end()), 0.1f);
  const double sphere = r * r * 10.0;
  EXPECT_LT(LargestDifference(sun, seenBy(LightType::Point, 4.0 * Pi * sphere)), 0.01);
  EXPECT_LT(LargestDifference(sun, seenBy(LightType::Spot, 2.0 * Pi * (1.0 - std::cos(Pi / 180.0)) * sphere)), 0.01);
  EXPECT_LT(LargestDifference(sun, seenBy(LightType::Rectangle, Pi * sphere)), 0.01);
}

// A lamp like the sun, and one that is told by a direction of extreme length.
TEST_F(ShadowRays, OfALampAsFarAsTheSunAreThoseOfASun)
{
  Scene scene = Blobs();
  scene.fluence.clear();
  scene.settings.shadowRays = true;
  const auto seenBy = [&](const Light& light) {
    scene.illumination.lights = { light };
    return scene.Seen(this->GetDevice()).radiance;
  };
  Light light;
  light.direction = { -0.6, 0.0, -0.8 };
  light.power = { 10.0, 10.0, 10.0 };
  const std::vector<float> sun = seenBy(light);
  light.direction = { -0.6e160, 0.0, -0.8e160 };
  EXPECT_LT(LargestDifference(sun, seenBy(light)), 1e-6);
  light.direction = { -0.6e-165, 0.0, -0.8e-165 };
  EXPECT_LT(LargestDifference(sun, seenBy(light)), 1e-6);
  light.type = LightType::Point;
  light.position = { 0.6e13, 0.0, 0.8e13 };
  light.power = Times(light.power, 4.0 * Pi * 1e26);
  EXPECT_LT(LargestDifference(sun, seenBy(light)), 1e-4);
}

// Whose cosine a float does not tell from 1: the cone's border is where it is.
TEST_F(ShadowRays, SeeNarrowConesAsWideAsTheyAre)
{
  Scene scene(GridOf(21, 1, 1));
  scene.grid.spacing = { 0.1, 1.0, 1.0 };
  scene.sigma_s = scene.Everywhere(1e-3);
  scene.settings.shadowRays = true;
  Light light;
  light.type = LightType::Spot;
  light.position = { 1.05, 0.5, 4500.5 };
  light.direction = { 0.0, 0.0, -1.0 };
  scene.illumination.lights = { light };
  const auto lit = [&](double angle) {
    scene.illumination.lights[0].angle = angle;
    const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 5.0));
    return std::accumulate(picture.radiance.begin(), picture.radiance.end(), 0.0) * angle * angle;
  };
  EXPECT_NEAR(lit(0.02) / lit(0.06), 15.0 / 21.0, 0.03); // to 0.785 from the axis
}

TEST_F(ShadowRays, SpotAndRectangleShineToOneSide)
{
  Scene scene(GridOf(20, 20, 20));
  scene.sigma_s = scene.Everywhere(1e-3);
  scene.settings.shadowRays = true;
  scene.settings.showBackground = false;
  Light light;
  light.position = { 10.0, 10.0, 10.0 };
  light.direction = { 1.0, 0.0, 0.0 };
  light.size = { 1.0, 1.0 };
  light.angle = 60.0;
  for (LightType type : { LightType::Spot, LightType::Rectangle })
  {
    light.type = type;
    scene.illumination.lights = { light };
    const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 5.0));
    const std::size_t middle = Middle(picture);
    EXPECT_GT(picture.radiance[3 * (middle + 8)], 0.0f);
    EXPECT_EQ(0.0f, picture.radiance[3 * (middle - 8)]);
    EXPECT_TRUE(
      std::all_of(picture.radiance.begin(), picture.radiance.end(), [](float v) { return std::isfinite(v); }));
  }
}

// Radiance times solid angle, however large it is.
TEST_F(ShadowRays, OfALargeRectangleBringWhatItShines)
{
  for (double edge : { 8.0, 24.0, 80.0, 800.0, 8000.0 })
  {
    Scene scene(GridOf(8, 8, 8));
    scene.sigma_s = scene.Everywhere(1e-6);
    scene.settings.shadowRays = true;
    scene.settings.showBackground = false;
    Light light;
    light.type = LightType::Rectangle;
    light.position = { 4.0, 4.0, 16.0 };
    light.direction = { 0.0, 0.0, -1.0 };
    light.size = { edge, edge };
    light.power = Times({ 1.0, 1.0, 1.0 }, Pi * edge * edge); // radiance 1
    scene.illumination.lights = { light };
    const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 5.0));
    double exact = 0.0;
    for (int i = 0; i < 8; ++i)
    {
      const double distance = 8.5 + i, half = 0.5 * edge;
      exact += 4.0 / 8.0 * std::atan2(half * half, distance * std::sqrt(2.0 * half * half + distance * distance));
    }
    EXPECT_NEAR(picture.radiance[3 * Middle(picture)] * 4.0 * Pi / 8e-6, exact, 0.06 * exact) << edge;
  }
}

// A medium so thin that every voxel gets 3 of the sun, 5 that was scattered and 2 straight from an environment.
TEST_F(ShadowRays, DirectLightCountsOnce)
{
  Scene scene(GridOf(8, 8, 8));
  scene.sigma_s = scene.Everywhere(1e-6);
  scene.settings.showBackground = false;
  Light sun;
  sun.power = { 3.0, 3.0, 3.0 };
  scene.illumination.lights = { sun };
  const auto seen = [&](bool shadowRays, bool single) {
    scene.settings.shadowRays = shadowRays;
    scene.settings.singleScatteringOnly = single;
    const Picture picture = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 5.0));
    return picture.radiance[3 * Middle(picture)] * 4.0 * Pi / (8.0 * 1e-6);
  };
  scene.fluence = scene.Everywhere(8.0);
  scene.fluenceDirect = scene.Everywhere(3.0);
  EXPECT_NEAR(8.0, seen(false, false), 1e-3);
  EXPECT_NEAR(8.0, seen(true, false), 1e-3);
  EXPECT_NEAR(3.0, seen(false, true), 1e-3);
  EXPECT_NEAR(3.0, seen(true, true), 1e-3);

  scene.fluence = scene.Everywhere(10.0);
  scene.fluenceDirect = scene.Everywhere(5.0);
  scene.illumination.environment = SmoothEnvironment();
  EXPECT_NEAR(10.0, seen(false, false), 1e-3);
  EXPECT_NEAR(10.0, seen(true, false), 1e-3);
  EXPECT_NEAR(5.0, seen(false, true), 1e-3);
}
}
