// The power that light from outside brings is known in closed form: area x radiance x what the direction set has of a
// half space.
#include "DeviceTest.h"
#include "MediumScene.h"

#include "LightPropagation/Angular/DirectionSet.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
constexpr double Rounding = 1e-6;

struct Setting
{
  std::array<int, 3> size;
  std::array<double, 3> spacing = { 1.0, 1.0, 1.0 };
  int directions = 25;
  int mapResolution = 1;
  bool staggered = false;
  std::array<bool, 3> periodic = {};
};

const std::vector<Setting> Settings = {
  { { 8, 8, 8 }, { 0.1, 0.1, 0.1 } },
  { { 10, 10, 10 } },
  { { 10, 10, 10 }, { 0.1, 0.1, 0.1 }, 64 },
  { { 16, 16, 16 }, { 1.0, 1.0, 1.0 }, 100, 1, true },
  { { 20, 20, 20 }, { 1.0, 1.0, 1.0 }, 36, 2 },
  { { 20, 20, 20 }, { 1.0, 1.0, 1.0 }, 49, 3, true },
  { { 7, 12, 9 }, { 1.0, 0.7, 1.9 } },
  { { 9, 4, 17 }, { 0.3, 2.0, 0.8 }, 36, 1, true },
  { { 33, 2, 5 }, { 1.0, 1.0, 1.0 }, 25, 2 },
  { { 12, 1, 12 } },
  { { 1, 1, 1 }, { 1.0, 2.0, 3.0 }, 64 },
  { { 6, 11, 5 }, { 1.0, 1.0, 1.0 }, 25, 1, false, { true, false, false } },
  { { 6, 11, 5 }, { 1.0, 1.5, 1.0 }, 36, 2, true, { false, true, true } },
};

std::string Text(const Setting& setting)
{
  std::string text;
  for (int a = 0; a < 3; ++a)
  {
    text += std::to_string(setting.size[a]) + " x " + std::to_string(setting.spacing[a]) +
      (setting.periodic[a] ? " periodic, " : ", ");
  }
  return text + std::to_string(setting.directions) + " directions, map " + std::to_string(setting.mapResolution) +
    (setting.staggered ? ", staggered" : "");
}

Scene SceneOf(const Setting& setting, float sigma_a, float sigma_s = 0.0f)
{
  Scene scene(setting.size, sigma_a, sigma_s);
  scene.medium.grid.spacing = setting.spacing;
  scene.settings.directionsPerFace = setting.directions;
  scene.settings.adaptDirections = false; // the flux of these directions is tested
  scene.settings.mapResolution = setting.mapResolution;
  scene.settings.staggeredRays = setting.staggered;
  scene.settings.periodic = setting.periodic;
  scene.settings.maximumOrders = 2;
  scene.settings.uncollidedDirections = 0;
  return scene;
}

double Area(const Grid& grid, int axis)
{
  return grid.Length((axis + 1) % 3) * grid.Length((axis + 2) % 3);
}

/// sum over directions towards +axis of w mu radiance.
double Flux(const DirectionSet& set, int axis, double sign, const std::vector<Rgb>& radiance)
{
  double flux = 0.0;
  for (std::size_t d = 0; d < set.directions.size(); ++d)
  {
    flux += set.directions[d].weight * std::max(sign * set.directions[d].omega[axis], 0.0) *
      (radiance.empty() ? 1.0 : radiance[d][0]);
  }
  return flux;
}

/// A sky that is bright on one side.
Environment Uneven()
{
  Environment environment;
  environment.width = 32;
  environment.height = 16;
  for (int j = 0; j < environment.height; ++j)
  {
    for (int i = 0; i < environment.width; ++i)
    {
      const double z = -std::cos(3.14159265358979 * (j + 0.5) / environment.height);
      const double x = std::cos(2.0 * 3.14159265358979 * (i + 0.5) / environment.width);
      environment.radiance.insert(environment.radiance.end(), 3, static_cast<float>(1.5 + z + 0.4 * x * z));
    }
  }
  return environment;
}
}

class EnteringPower : public DeviceTest
{
};

TEST_F(EnteringPower, OfAFaceIsItsAreaTimesTheFluxOfTheDirections)
{
  for (const Setting& setting : Settings)
  {
    for (int face = 0; face < 6; ++face)
    {
      Scene scene = SceneOf(setting, 0.4f, 0.9f);
      scene.light.faces[face] = { 2.0, 2.0, 2.0 };
      const LightField light = scene.Solve(this->GetDevice());
      const DirectionSet set = FittedDirections(setting.directions);
      const double exact =
        setting.periodic[face / 2] ? 0.0 : 2.0 * Area(scene.medium.grid, face / 2) * Flux(set, face / 2, 1.0, {});
      EXPECT_NEAR(light.balance.entered[0], exact, Rounding * exact) << Text(setting) << ", face " << face;
      EXPECT_NEAR(light.halfRangeFlux[0], Flux(set, face / 2, 1.0, {}) / 3.14159265358979, 1e-9) << Text(setting);
      EXPECT_LT(light.balance.RelativeError(1), 1e-5) << Text(setting) << ", face " << face;
    }
  }
}

TEST_F(EnteringPower, OfAnEvenSkyIsTheSurfaceTimesTheFluxOfTheDirections)
{
  for (const Setting& setting : Settings)
  {
    Scene scene = SceneOf(setting, 0.4f, 0.9f);
    scene.ShineFromEverywhere(1.0);
    const LightField light = scene.Solve(this->GetDevice());
    double exact = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      exact += setting.periodic[axis]
        ? 0.0
        : 2.0 * Area(scene.medium.grid, axis) * Flux(FittedDirections(setting.directions), axis, 1.0, {});
    }
    EXPECT_NEAR(light.balance.entered[0], exact, Rounding * exact) << Text(setting);
  }
}

TEST_F(EnteringPower, OfAnEnvironmentIsItsFluxThroughEveryFace)
{
  const Environment environment = Uneven();
  for (const Setting& setting : Settings)
  {
    Scene scene = SceneOf(setting, 0.4f, 0.9f);
    scene.light.environment = environment;
    const LightField light = scene.Solve(this->GetDevice());
    const DirectionSet set = FittedDirections(setting.directions);
    const std::vector<Rgb> radiance = BoundaryRadiance(set, environment, {});
    double exact = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double both = Flux(set, axis, 1.0, radiance) + Flux(set, axis, -1.0, radiance);
      exact += setting.periodic[axis] ? 0.0 : Area(scene.medium.grid, axis) * both;
    }
    EXPECT_NEAR(light.balance.entered[0], exact, Rounding * exact) << Text(setting);
  }
}

TEST_F(EnteringPower, OfTheSunIsItsIrradianceTimesTheShadowsArea)
{
  for (const Setting& setting : Settings)
  {
    for (std::array<double, 3> direction :
      { std::array<double, 3>{ 0.3, -0.5, -0.8 }, { 1.0, 1.0, 0.2 }, { -1.0, 2.0, 4.0 } })
    {
      Scene scene = SceneOf(setting, 0.4f, 0.9f);
      scene.ShineAlong(direction, 3.0);
      const LightField light = scene.Solve(this->GetDevice());
      const double length = std::hypot(direction[0], direction[1], direction[2]);
      double exact = 0.0;
      for (int axis = 0; axis < 3; ++axis)
      {
        exact +=
          setting.periodic[axis] ? 0.0 : 3.0 * Area(scene.medium.grid, axis) * std::abs(direction[axis]) / length;
      }
      EXPECT_NEAR(light.balance.entered[0], exact, Rounding * exact) << Text(setting) << ", " << direction[0];
    }
  }
}

TEST_F(EnteringPower, IsAbsorbedByABlackBox)
{
  // But what goes exactly through the edges of the box: directions on diagonals run along the edges of voxels, so that
  // part of one ray in a row of them meets no voxel.
  for (const Setting& setting : Settings)
  {
    Scene scene = SceneOf(setting, 1e5f);
    scene.ShineFromEverywhere(1.0);
    const LightField light = scene.Solve(this->GetDevice());
    const double rays = setting.mapResolution * *std::min_element(setting.size.begin(), setting.size.end());
    EXPECT_LT(light.balance.escaped[0], 0.1 / rays * light.balance.entered[0] + 1e-3) << Text(setting);
    EXPECT_LT(light.balance.RelativeError(1), 1e-5) << Text(setting);
  }
}

TEST_F(EnteringPower, LeavesAnEvenSkyEvenAtEveryDepth)
{
  // Emission that makes up for absorption: radiance 1 in every voxel.
  for (const Setting& setting : Settings)
  {
    Scene scene = SceneOf(setting, 0.7f);
    scene.emission.assign(scene.sigma_a.size(), 0.7f);
    scene.ShineFromEverywhere(1.0);
    const LightField light = scene.Solve(this->GetDevice());
    for (const float fluence : light.fluence)
    {
      ASSERT_NEAR(fluence / (4.0 * 3.14159265358979), 1.0, 1e-5) << Text(setting);
    }
  }
}
