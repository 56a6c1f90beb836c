#include "DeviceTest.h"
#include "MediumScene.h"

#include <cmath>

using namespace tyndall;

namespace
{
constexpr double Pi = 3.14159265358979323846;

Light Lamp(LightType type, std::array<double, 3> position, double power = 10.0)
{
  Light lamp;
  lamp.type = type;
  lamp.position = position;
  lamp.direction = { 0.0, 0.0, 1.0 };
  lamp.power = { power, power, power };
  lamp.angle = 60.0;
  lamp.size = { 2.0, 2.0 };
  return lamp;
}

double FluenceAt(const LightField& light, const Scene& scene, int x, int y, int z)
{
  const std::array<int, 3>& n = scene.medium.grid.size;
  return light.fluence[(static_cast<std::size_t>(z) * n[1] + y) * n[0] + x];
}
}

class LampBeams : public DeviceTest
{
};

TEST_F(LampBeams, LampsInsideAndOutsideKeepTheirPower)
{
  for (LightType type : { LightType::Point, LightType::Spot, LightType::Rectangle })
  {
    for (double sigma : { 0.0, 1e-5, 0.2, 1e5 })
    {
      for (double z : { 6.3, -4.0 })
      {
        Scene scene({ 12, 13, 14 }, static_cast<float>(sigma), static_cast<float>(sigma));
        scene.light.lights = { Lamp(type, { 6.2, 6.1, z }) };
        scene.settings.maximumOrders = 2;
        const LightField light = scene.Solve(this->GetDevice());
        EXPECT_LT(light.balance.RelativeError(1), 1e-5) << static_cast<int>(type) << ' ' << sigma << ' ' << z;
        if (z > 0.0)
        {
          EXPECT_NEAR(light.balance.entered[0], 10.0, 1e-4);
        }
        else
        {
          EXPECT_LT(light.balance.entered[0], 10.0 * 1.03);
          EXPECT_GT(light.balance.entered[0], 1.0);
        }
      }
    }
  }
}

TEST_F(LampBeams, NetFluxPointsAwayFromTheLamp)
{
  Scene scene({ 11, 9, 10 }, 0.02f, 0.0f);
  const std::array<double, 3> position = { 2.6, 3.4, -3.0 };
  scene.light.lights = { Lamp(LightType::Point, position) };
  scene.settings.netFlux = true;
  const LightField light = scene.Solve(this->GetDevice());
  std::size_t i = 0;
  for (int z = 0; z < 10; ++z)
  {
    for (int y = 0; y < 9; ++y)
    {
      for (int x = 0; x < 11; ++x, ++i)
      {
        const std::array<double, 3> away = { x + 0.5 - position[0], y + 0.5 - position[1], z + 0.5 - position[2] };
        const double distance = std::sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
        for (int a = 0; a < 3; ++a)
        {
          EXPECT_NEAR(light.netFlux[3 * i + a], light.fluence[i] * away[a] / distance, 0.03 * light.fluence[i]);
        }
      }
    }
  }
}

TEST_F(LampBeams, ASpotBringsItsPowerHoweverNarrowItIs)
{
  for (int n : { 8, 16, 33 })
  {
    for (double angle : { 0.5, 2.0, 5.0, 10.0, 20.0, 40.0, 90.0, 180.0 })
    {
      Scene scene({ n, n, n }, 0.01f, 0.0f);
      Light spot = Lamp(LightType::Spot, { 0.51 * n, 0.52 * n, 0.53 * n });
      spot.angle = angle;
      spot.direction = { 0.3, -0.2, 1.0 };
      scene.light.lights = { spot };
      EXPECT_NEAR(scene.Solve(this->GetDevice()).balance.entered[0], 10.0, 1e-4) << n << ' ' << angle;
      if (angle <= 20.0)
      {
        spot.position = { 0.35 * n, 0.63 * n, -0.8 * n };
        scene.light.lights = { spot };
        EXPECT_NEAR(scene.Solve(this->GetDevice()).balance.entered[0], 10.0, 0.05) << n << ' ' << angle << " outside";
      }
    }
  }
}

TEST_F(LampBeams, APointOutsideBringsWhatTheFaceSeesOfIt)
{
  for (int n : { 4, 16, 40 })
  {
    for (double distance : { 0.3, 1.0, 3.0 }) // of the box's edge
    {
      Scene scene({ n, n, n }, 0.0f, 0.0f);
      scene.light.lights = { Lamp(LightType::Point, { 0.5 * n, 0.5 * n, -distance * n }) };
      const double seen = 4.0 * std::asin(0.25 / (0.25 + distance * distance)); // solid angle of a square on its axis
      EXPECT_NEAR(scene.Solve(this->GetDevice()).balance.entered[0] / (10.0 * seen / (4.0 * Pi)), 1.0, 1e-3)
        << n << ' ' << distance;
    }
  }
}

TEST_F(LampBeams, APointInAbsorberFollowsTheInverseSquareAndTheExponential)
{
  const double sigma = 0.1;
  Scene scene({ 33, 33, 33 }, static_cast<float>(sigma), 0.0f);
  scene.light.lights = { Lamp(LightType::Point, { 16.5, 16.5, 16.5 }) };
  const LightField light = scene.Solve(this->GetDevice());
  for (const std::array<int, 3>& voxel :
    { std::array<int, 3>{ 26, 16, 16 }, { 16, 5, 16 }, { 24, 25, 23 }, { 10, 6, 29 } })
  {
    const double r = std::hypot(voxel[0] - 16.0, voxel[1] - 16.0, voxel[2] - 16.0);
    const double exact = 10.0 * std::exp(-sigma * r) / (4.0 * Pi * r * r);
    EXPECT_NEAR(FluenceAt(light, scene, voxel[0], voxel[1], voxel[2]) / exact, 1.0, 0.03) << r;
  }
}

TEST_F(LampBeams, ARectangleShinesByTheCosineAndOnOneSideOnly)
{
  Scene scene({ 31, 31, 31 }, 0.0f, 0.0f);
  scene.light.lights = { Lamp(LightType::Rectangle, { 15.5, 15.5, 5.0 }) };
  const LightField light = scene.Solve(this->GetDevice());
  EXPECT_NEAR(FluenceAt(light, scene, 15, 15, 27) / (10.0 / (Pi * 22.5 * 22.5)), 1.0, 0.05);
  const double r = std::hypot(10.0, 22.5);
  EXPECT_NEAR(FluenceAt(light, scene, 25, 15, 27) / (10.0 * (22.5 / r) / (Pi * r * r)), 1.0, 0.05);
  EXPECT_EQ(FluenceAt(light, scene, 15, 15, 2), 0.0);
  EXPECT_NEAR(light.facePowerOut[4][0], 0.0, 1e-6);
}

TEST_F(LampBeams, ASpotLightsItsConeOnly)
{
  Scene scene({ 31, 31, 31 }, 0.0f, 0.0f);
  scene.light.lights = { Lamp(LightType::Spot, { 15.5, 15.5, 0.5 }) };
  const LightField light = scene.Solve(this->GetDevice());
  const double intensity = 10.0 / (2.0 * Pi * (1.0 - std::cos(30.0 * Pi / 180.0)));
  EXPECT_NEAR(FluenceAt(light, scene, 15, 15, 25) / (intensity / 625.0), 1.0, 0.03);
  EXPECT_EQ(FluenceAt(light, scene, 30, 15, 10), 0.0);
}

TEST_F(LampBeams, LampsGiveTheSameLightBitForBit)
{
  Scene scene({ 16, 16, 16 });
  scene.Randomise(1.0, 4.0, 0.5);
  scene.light.lights = { Lamp(LightType::Point, { 8.0, 8.0, 8.0 }), Lamp(LightType::Rectangle, { 3.0, 4.0, 1.0 }) };
  scene.settings.maximumOrders = 2;
  EXPECT_EQ(scene.Solve(this->GetDevice()).fluence, scene.Solve(this->GetDevice()).fluence);
}

TEST_F(LampBeams, AnIsolatedOpaqueVoxelStopsEveryRay)
{
  Scene scene({ 9, 9, 9 }, 0.0f, 0.0f);
  scene.sigma_a[(4 * 9 + 4) * 9 + 4] = 1e9f;
  scene.light.lights = { Lamp(LightType::Point, { 4.5, 4.5, 4.5 }) };
  const LightField light = scene.Solve(this->GetDevice());
  EXPECT_NEAR(light.balance.absorbed[0], 10.0, 1e-3);
  EXPECT_NEAR(light.balance.escaped[0], 0.0, 1e-6);
}

namespace
{
/// Integral of exp(-x / m) over m from 0 to 1.
double ExponentialIntegral2(double x)
{
  constexpr int points = 4000;
  double sum = 0.0;
  for (int i = 0; i < points; ++i)
  {
    const double root = (i + 0.5) / points; // most where m is small
    sum += 3.0 * root * root * std::exp(-x / (root * root * root)) / points;
  }
  return sum;
}
}

TEST_F(LampBeams, RoundPeriodicAxesLeaveNothingOver)
{
  struct Case
  {
    std::array<int, 3> size;
    std::array<double, 3> spacing;
    double tau; ///< across the last axis
    std::array<bool, 3> periodic;
    LightType type;
  };
  for (const Case& box : { Case{ { 17, 12, 20 }, { 1.0, 1.0, 1.0 }, 0.1, { true, true, false }, LightType::Spot },
         Case{ { 4, 4, 32 }, { 1.0, 1.0, 1.0 }, 0.1, { true, true, false }, LightType::Rectangle },
         Case{ { 8, 6, 10 }, { 0.01, 0.01, 1.0 }, 0.3, { true, true, false }, LightType::Point },
         Case{ { 9, 11, 10 }, { 1.0, 1.3, 0.8 }, 0.0, { true, false, false }, LightType::Point },
         Case{ { 9, 7, 8 }, { 1.0, 1.0, 1.0 }, 1e-3, { true, true, true }, LightType::Point } })
  {
    Scene scene(box.size, static_cast<float>(box.tau / (box.size[2] * box.spacing[2])));
    scene.medium.grid.spacing = box.spacing;
    scene.settings.periodic = box.periodic;
    Light lamp = Lamp(box.type,
      { 0.41 * box.size[0] * box.spacing[0], 0.53 * box.size[1] * box.spacing[1],
        0.37 * box.size[2] * box.spacing[2] });
    lamp.direction = { 0.8, 0.3, 0.1 };
    lamp.size = { box.spacing[0], box.spacing[0] };
    scene.light.lights = { lamp };
    const LightField light = scene.Solve(this->GetDevice());
    EXPECT_LT(light.balance.leftOver[0], 1e-3 * light.balance.entered[0]) << box.size[2] << ' ' << box.tau;
    EXPECT_LT(light.balance.RelativeError(1), 1e-4) << box.size[2] << ' ' << box.tau; // measured: 5e-5 for the spot
    EXPECT_NEAR(light.balance.entered[0], 10.0, 1e-4);
  }
}

TEST_F(LampBeams, InASlabOfPeriodicBoxesLightPlanesAsAPlaneOfLampsDoes)
{
  // Mean over a layer of power / (2 area) E1(sigma |z - lamp|).
  for (const std::array<int, 3>& n : { std::array<int, 3>{ 4, 4, 48 }, { 13, 10, 22 } })
  {
    constexpr double tau = 0.2;
    Scene scene(n, static_cast<float>(tau / n[2]));
    scene.settings.periodic = { true, true, false };
    const double z = 0.5 * (n[2] / 2) + 0.5;
    scene.light.lights = { Lamp(LightType::Point, { 0.4 * n[0], 0.6 * n[1], z }) };
    const LightField light = scene.Solve(this->GetDevice());
    for (int layer = 0; layer < n[2]; ++layer)
    {
      if (std::abs(layer + 0.5 - z) < 2.0)
      {
        continue; // beside the lamp: a logarithm
      }
      double mean = 0.0;
      for (int i = 0; i < n[0] * n[1]; ++i)
      {
        mean += light.fluence[static_cast<std::size_t>(layer) * n[0] * n[1] + i] / (n[0] * n[1]);
      }
      const double sigma = tau / n[2];
      const double below = sigma * std::abs(layer - z), above = sigma * std::abs(layer + 1 - z);
      const double exact =
        10.0 / (2.0 * n[0] * n[1] * sigma) * std::abs(ExponentialIntegral2(below) - ExponentialIntegral2(above));
      // Beams are up to a voxel wide: in the outermost layers a part of them has left already. Measured: 12%.
      const bool outermost = layer == 0 || layer == n[2] - 1;
      EXPECT_NEAR(mean / exact, 1.0, outermost ? 0.15 : 0.05) << n[2] << ": " << layer;
    }
  }
}
