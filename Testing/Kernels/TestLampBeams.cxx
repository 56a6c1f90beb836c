#include "DeviceTest.h"
#include "Medium/Grid.h"
#include "MediumScene.h"
#include "RectangleSeen.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"
#include "Photons/Emission/PhotonPlane.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <string>

using namespace tyndall;

namespace
{
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
  ForGridVoxels({ 11, 9, 10 }, [&](std::size_t i, int x, int y, int z) {
    const std::array<double, 3> away = { x + 0.5 - position[0], y + 0.5 - position[1], z + 0.5 - position[2] };
    const double distance = std::sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
    for (int a = 0; a < 3; ++a)
    {
      EXPECT_NEAR(light.netFlux[3 * i + a], light.fluence[i] * away[a] / distance, 0.03 * light.fluence[i]);
    }
  });
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

// A laser's divergence, and less: down to what a spot may have.
TEST_F(LampBeams, ASpotBringsItsPowerHoweverNarrowItIsFromAnywhere)
{
  for (double angle : { 1e-12, 1e-9, 1e-6, 1e-3, 0.03, 0.1, 3.0, 20.0, 45.0 })
  {
    for (const std::array<double, 3>& direction : { std::array<double, 3>{ 0.0, 0.0, 1.0 }, { 0.11, -0.2, 0.9 } })
    {
      for (double distance : { 0.01, 4.0, 9.0 }) // within, on the same side of the middle, outside
      {
        Scene scene({ 16, 10, 12 }, 0.02f, 0.0f);
        scene.medium.grid.spacing = { 0.3, 1.0, 2.0 };
        scene.medium.grid.origin = { 100.0, -3.0, 7.0 };
        Light spot = Lamp(LightType::Spot, {}, 1.0);
        spot.angle = angle;
        spot.direction = direction;
        for (int a = 0; a < 3; ++a)
        {
          spot.position[a] = scene.medium.grid.origin[a] + 0.5 * scene.medium.grid.Length(a) - distance * direction[a];
        }
        spot.position[2] -= distance > 5.0 ? 4.0 : 0.0;
        spot.power = { 1.0, 0.5, 0.25 };
        scene.light.lights = { spot };
        const LightField light = scene.Solve(this->GetDevice());
        const bool whole = distance < 5.0 || angle <= 3.0;
        EXPECT_NEAR(light.balance.entered[0], 1.0, whole ? 1e-4 : 0.2) << angle << ' ' << distance;
        EXPECT_NEAR(light.balance.entered[2] / light.balance.entered[0], 0.25, 1e-6);
        EXPECT_LT(light.balance.RelativeError(3), 1e-5);
      }
    }
  }
}

TEST_F(LampBeams, ANarrowerSpotIsRefused)
{
  Scene scene({ 4, 4, 4 }, 0.02f, 0.0f);
  Light spot = Lamp(LightType::Spot, { 2.0, 2.0, 2.0 });
  for (double angle : { 0.0, 1e-13, 180.1, std::nan("") })
  {
    spot.angle = angle;
    scene.light.lights = { spot };
    EXPECT_THROW(scene.Solve(this->GetDevice()), InvalidInput) << angle;
  }
}

// Above a face's edge: by symmetry half of the cone comes in, above a corner a quarter.
TEST_F(LampBeams, ASpotHalfBesideTheBoxBringsHalf)
{
  for (double angle : { 1e-6, 0.1, 10.0, 40.0 })
  {
    Scene scene({ 14, 16, 12 }, 0.0f, 0.0f);
    Light spot = Lamp(LightType::Spot, { 0.0, 7.9, -9.0 });
    spot.angle = angle;
    scene.light.lights = { spot };
    EXPECT_NEAR(scene.Solve(this->GetDevice()).balance.entered[0], 5.0, 5e-4) << angle;
    scene.light.lights[0].position = { 0.0, 0.0, -9.0 };
    EXPECT_NEAR(scene.Solve(this->GetDevice()).balance.entered[0], 2.5, 5e-4) << angle;
  }
}

namespace
{
/// Largest error of the fluence that a lamp brings to a vacuum, relative to the inverse square.
double ErrorOfInverseSquare(const LightField& light, const Scene& scene, const Light& lamp)
{
  const Grid& grid = scene.medium.grid;
  double largest = 0.0;
  for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
  {
    const std::array<int, 3> voxel = grid.VoxelAt(i);
    std::array<double, 3> way;
    for (int a = 0; a < 3; ++a)
    {
      way[a] = grid.origin[a] + (voxel[a] + 0.5) * grid.spacing[a] - lamp.position[a];
    }
    const double part = lamp.type == LightType::Rectangle ? std::cos(AngleFromAxis(lamp, way)) : 1.0;
    const double exact =
      lamp.power[0] * AxialIntensity(lamp) * part / (way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    largest = std::max(largest, std::abs(light.fluence[i] / exact - 1.0));
  }
  return largest;
}
}

TEST_F(LampBeams, AFarLampFollowsTheInverseSquareInEveryVoxel)
{
  for (double distance : { 3.0, 10.0, 990.0, 9e4, 2.5e10 }) // of the longest edge
  {
    for (const std::array<double, 3>& away : { std::array<double, 3>{ 0.0, 0.0, -1.0 }, { 0.6, 0.0, 0.8 },
           { -0.3, 0.8, 0.51962 }, { 0.57735, -0.57735, 0.57735 } })
    {
      Scene scene({ 13, 10, 11 }, 0.0f, 0.0f);
      scene.medium.grid.spacing = { 1.0, 0.7, 1.3 };
      Light lamp = Lamp(LightType::Point, {}, 10.0 * distance * distance);
      lamp.angle = 60.0;
      for (int a = 0; a < 3; ++a)
      {
        lamp.position[a] = 0.5 * scene.medium.grid.Length(a) + distance * scene.medium.grid.Length(2) * away[a];
        lamp.direction[a] = -away[a] + 0.1;
      }
      for (LightType type : { LightType::Point, LightType::Spot, LightType::Rectangle })
      {
        lamp.type = type;
        scene.light.lights = { lamp };
        const LightField light = scene.Solve(this->GetDevice());
        EXPECT_LT(ErrorOfInverseSquare(light, scene, lamp), 0.01)
          << distance << ' ' << away[0] << ' ' << static_cast<int>(type);
        EXPECT_LT(light.balance.RelativeError(1), 1e-5);
      }
    }
  }
}

TEST_F(LampBeams, ALaserFromFarAwayIsAimedInDoubles)
{
  Scene scene({ 12, 12, 12 }, 0.01f, 0.0f);
  Light spot = Lamp(LightType::Spot, { 6.0 + 3e6, 6.0, 6.0 + 4e6 }, 1.0);
  spot.direction = { -3e6 + 1.0, 0.0, -4e6 }; // to (7, 6, 6), as wide there as 0.87 voxels
  spot.angle = 1e-5;
  scene.light.lights = { spot };
  const LightField light = scene.Solve(this->GetDevice());
  EXPECT_NEAR(light.balance.entered[0], 1.0, 1e-4);
  const double there = FluenceAt(light, scene, 6, 6, 5) + FluenceAt(light, scene, 7, 6, 6),
               beside = FluenceAt(light, scene, 6, 6, 8);
  EXPECT_GT(there, 0.5);
  EXPECT_EQ(beside, 0.0);
  spot.position = { 6.0, 6.0, 1e10 };
  spot.direction = { 0.0, 0.0, -1.0 };
  spot.angle = 1e-9;
  scene.light.lights = { spot };
  EXPECT_NEAR(scene.Solve(this->GetDevice()).balance.entered[0], 1.0, 1e-4);
  scene.light.lights[0].position = { 6.0, 6.0, 1e12 };
  EXPECT_THROW(scene.Solve(this->GetDevice()), InvalidInput);
}

TEST_F(LampBeams, DirectionsMayHaveAnyLength)
{
  for (LightType type : { LightType::Directional, LightType::Spot, LightType::Rectangle })
  {
    Scene scene({ 6, 5, 7 }, 0.1f, 0.0f);
    Light lamp = Lamp(type, { 3.0, 2.0, -2.0 });
    std::vector<float> unit;
    for (double length : { 1.0, 1e-165, 1e-300, 1e160, 1e300 })
    {
      lamp.direction = { 0.1 * length, 0.3 * length, 0.8 * length };
      scene.light.lights = { lamp };
      const std::vector<float> fluence = scene.Solve(this->GetDevice()).fluence;
      unit = unit.empty() ? fluence : unit;
      for (std::size_t i = 0; i < unit.size(); ++i)
      {
        ASSERT_NEAR(fluence[i], unit[i], 1e-6f * unit[i]) << length;
      }
    }
    for (double bad : { 0.0, static_cast<double>(INFINITY), std::nan("") })
    {
      scene.light.lights[0].direction = { 0.0, bad, 0.0 };
      EXPECT_THROW(scene.Solve(this->GetDevice()), InvalidInput) << bad;
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
constexpr std::array<double, 3> UnevenLengths = { 7.0, 6.4, 7.8 };

/// A grey box of uneven voxels in the light of one lamp.
LightField LitBy(Device& device, const Light& lamp, std::array<bool, 3> periodic = {})
{
  Scene scene({ 7, 8, 6 }, 0.05f);
  scene.medium.grid.spacing = { 1.0, 0.8, 1.3 };
  scene.settings.periodic = periodic;
  scene.light.lights = { lamp };
  return scene.Solve(device);
}

/// Solid angle of that box from a point below it.
double SolidAngleFromBelow(const std::array<double, 3>& eye)
{
  const auto corner = [](double a, double b, double d) {
    return std::atan2(a * b, d * std::sqrt(a * a + b * b + d * d));
  };
  const double x0 = -eye[0], x1 = UnevenLengths[0] - eye[0], y0 = -eye[1], y1 = UnevenLengths[1] - eye[1];
  return corner(x1, y1, -eye[2]) - corner(x0, y1, -eye[2]) - corner(x1, y0, -eye[2]) + corner(x0, y0, -eye[2]);
}
}

TEST_F(LampBeams, OnAFaceAnEdgeAndACornerALampShinesInwardsOnly)
{
  for (int border = 1; border < 27; ++border) // a digit an axis; 1: on the low face, 2: on the high one
  {
    std::array<double, 3> position = {};
    double part = 1.0;
    for (int a = 0, digits = border; a < 3; ++a, digits /= 3)
    {
      position[a] = UnevenLengths[a] * (digits % 3 == 0 ? 0.41 : digits % 3 - 1.0);
      part *= digits % 3 == 0 ? 1.0 : 0.5;
    }
    const LightField light = LitBy(this->GetDevice(), Lamp(LightType::Point, position));
    EXPECT_NEAR(light.balance.entered[0], 10.0 * part, 10.0 * part * 1e-3) << border;
    EXPECT_LT(light.balance.RelativeError(1), 1e-5) << border;
  }
}

// By the rays of its cone that meet the box.
TEST_F(LampBeams, OfASpotThatShinesPartlyBesideTheBoxEntersWhatMeetsIt)
{
  const std::array<double, 3> middle = { 2.0, 5.0, 6.0 };
  for (double angle : { 5.0, 40.0, 110.0, 180.0 })
  {
    for (const std::array<double, 3>& position : { std::array<double, 3>{ -3.0, 2.0, 5.0 }, { 7.0, 13.0, -4.0 } })
    {
      for (double aside : { 1.0, 4.0, 40.0 })
      {
        Scene scene({ 10, 10, 6 }, 0.02f, 0.0f);
        scene.medium.grid.spacing = { 0.4, 1.0, 2.0 };
        Light spot = Lamp(LightType::Spot, position, 1.0);
        spot.angle = angle;
        for (int a = 0; a < 3; ++a)
        {
          spot.direction[a] = middle[a] + (a == 1 ? aside : 0.0) - position[a];
        }
        scene.light.lights = { spot };
        const double found = scene.Solve(this->GetDevice()).balance.entered[0];
        constexpr int n = 500;
        const glm::dvec3 axis = glm::normalize(Vector(spot.direction));
        const glm::dvec3 u = glm::normalize(glm::cross(axis, glm::dvec3(0.3, 0.5, 0.8))), v = glm::cross(axis, u);
        const double least = std::cos(angle * Pi / 360.0);
        int meets = 0;
        for (int i = 0; i < n * n; ++i)
        {
          const double cosine = 1.0 - (1.0 - least) * (i / n + 0.5) / n, sine = std::sqrt(1.0 - cosine * cosine);
          const double turn = 2.0 * Pi * (i % n + 0.5) / n;
          const glm::dvec3 way = cosine * axis + sine * (std::cos(turn) * u + std::sin(turn) * v);
          double from = 0.0, to = 1e9;
          for (int a = 0; a < 3; ++a)
          {
            const double first = -position[a] / way[a], last = (scene.medium.grid.Length(a) - position[a]) / way[a];
            from = std::max(from, std::min(first, last));
            to = std::min(to, std::max(first, last));
          }
          meets += from < to ? 1 : 0;
        }
        EXPECT_NEAR(found, static_cast<double>(meets) / (n * n), 1e-3 * found + 2e-5) << angle << ' ' << aside;
      }
    }
  }
}

TEST_F(LampBeams, LightDoesNotJumpWhereALampGoesThroughAFace)
{
  for (LightType type : { LightType::Point, LightType::Spot, LightType::Rectangle })
  {
    for (int face = 0; face < 6; ++face)
    {
      const int axis = face / 2;
      const double wall = face % 2 ? UnevenLengths[axis] : 0.0, outwards = face % 2 ? 1.0 : -1.0;
      const auto at = [&](double beyond) {
        Light lamp = Lamp(type, { 0.41 * UnevenLengths[0], 0.37 * UnevenLengths[1], 0.53 * UnevenLengths[2] });
        lamp.position[axis] = wall + outwards * beyond;
        lamp.direction = { 0.3, 0.2, 0.1 };
        lamp.direction[axis] = -outwards;
        return LitBy(this->GetDevice(), lamp);
      };
      const LightField within = at(-1e-4), on = at(0.0), beyond = at(1e-4);
      const double largest = *std::max_element(on.fluence.begin(), on.fluence.end());
      for (std::size_t i = 0; i < on.fluence.size(); ++i)
      {
        EXPECT_NEAR(within.fluence[i], on.fluence[i], 0.01 * on.fluence[i] + 1e-3 * largest) << face << ' ' << i;
        EXPECT_NEAR(beyond.fluence[i], on.fluence[i], 0.01 * on.fluence[i] + 1e-3 * largest) << face << ' ' << i;
      }
      EXPECT_NEAR(within.balance.absorbed[0], on.balance.absorbed[0], 2e-3 * on.balance.absorbed[0]) << face;
      EXPECT_NEAR(beyond.balance.absorbed[0], on.balance.absorbed[0], 2e-3 * on.balance.absorbed[0]) << face;
      if (type != LightType::Rectangle) // half of which is outside
      {
        EXPECT_NEAR(within.balance.entered[0], 10.0, 1e-2) << face;
      }
      EXPECT_LT(within.balance.RelativeError(1), 1e-5) << face;
    }
  }
}

TEST_F(LampBeams, InsideAllPowerEntersAndOutsideThatOfTheSolidAngle)
{
  for (double z : { 3.0, 1.2, 0.4, 0.13, 0.01, 1e-4, -1e-4, -0.01, -0.13, -0.4, -1.3, -4.0 })
  {
    const Light lamp = Lamp(LightType::Point, { 2.9, 2.6, z });
    const double part = z > 0.0 ? 1.0 : SolidAngleFromBelow(lamp.position) / (4.0 * Pi);
    const LightField light = LitBy(this->GetDevice(), lamp);
    EXPECT_NEAR(light.balance.entered[0] / (10.0 * part), 1.0, 1e-3) << z;
    EXPECT_LT(light.balance.RelativeError(1), 1e-5) << z;
    for (const std::array<double, 3>& direction : { std::array<double, 3>{ 1.0, 0.4, 0.3 }, { 0.0, 1.0, 0.0 } })
    {
      Light spot = Lamp(LightType::Spot, lamp.position);
      spot.direction = direction;
      EXPECT_NEAR(LitBy(this->GetDevice(), spot).balance.entered[0], 10.0, z > 0.0 ? 1e-2 : 10.0) << z;
    }
  }
}

TEST_F(LampBeams, OnTheEndOfAPeriodicAxisALampIsInside)
{
  for (double x : { 0.0, 7.0 })
  {
    const std::array<bool, 3> alongX = { true, false, false };
    const LightField light = LitBy(this->GetDevice(), Lamp(LightType::Point, { x, 3.0, 0.0 }), alongX);
    EXPECT_NEAR(light.balance.entered[0], 5.0, 5e-3) << x;
    EXPECT_LT(light.balance.RelativeError(1), 1e-4) << x;
    const double beside = x > 0.0 ? x - 1e-3 : 1e-3;
    const LightField within = LitBy(this->GetDevice(), Lamp(LightType::Point, { beside, 3.0, 0.0 }), alongX);
    EXPECT_NEAR(light.balance.absorbed[0] / within.balance.absorbed[0], 1.0, 2e-3) << x;
  }
}

namespace
{
Light Rectangle(
  std::array<double, 3> position, std::array<double, 3> direction, double width, double height, double turned = 0.0)
{
  Light light = Lamp(LightType::Rectangle, position);
  light.direction = direction;
  light.size = { width, height };
  light.angle = turned;
  return light;
}

struct RectangleInBox
{
  Light light;
  std::array<int, 3> size = { 10, 10, 10 };
  std::array<double, 3> spacing = { 1.0, 1.0, 1.0 };
};

/// Up to a thousand times as large as the box, lying on it, through its faces, before it, small within, slanted.
const RectangleInBox Rectangles[] = {
  { Rectangle({ 5.0, 5.0, 12.0 }, { 0.0, 0.0, -1.0 }, 100.0, 100.0) },
  { Rectangle({ 5.0, 5.0, 30.0 }, { 0.0, 0.0, -1.0 }, 330.0, 330.0) },
  { Rectangle({ -0.3, 5.0, 5.0 }, { 1.0, 0.0, 0.0 }, 1000.0, 700.0) },
  { Rectangle({ 5.0, 15.0, 5.0 }, { 0.0, -1.0, 0.0 }, 1e4, 1e4) },
  { Rectangle({ 11.0, 3.0, 2.0 }, { 0.0, 0.0, -1.0 }, 20.0, 20.0, 10.0), { 22, 6, 2 } },
  { Rectangle({ 5.0, 5.0, 10.0 }, { 0.0, 0.0, -1.0 }, 10.0, 10.0) },
  { Rectangle({ 5.1, 5.3, 5.5 }, { 0.3, -0.5, 0.7 }, 6.0, 4.0) },
  { Rectangle({ 5.5, 5.5, 5.5 }, { 0.0, 0.0, 1.0 }, 0.2, 0.1) },
  { Rectangle({ 5.2, 5.4, 5.0 }, { 1.0, 0.0, 0.0 }, 0.7, 12.0) },
  { Rectangle({ 0.0, 5.2, 4.0 }, { 0.2, 0.1, -1.0 }, 5.0, 7.0), { 14, 9, 6 }, { 0.6, 1.0, 2.0 } },
  { Rectangle({ -30.0, 5.0, 22.0 }, { 0.6, 0.0, -0.4 }, 30.0, 12.0) },
  { Rectangle({ 5.0, 5.0, -13.0 }, { 0.0, 0.1, 1.0 }, 10.0, 10.0) },
  { Rectangle({ 6.0, 2.1, -1.0 }, { -0.3, -0.2, 0.03 }, 0.4, 0.25), { 8, 4, 7 } },
};

Scene VacuumAround(const RectangleInBox& rectangle)
{
  Scene scene(rectangle.size);
  scene.medium.grid.spacing = rectangle.spacing;
  scene.light.lights = { rectangle.light };
  return scene;
}

std::string NameOf(const Light& light)
{
  return std::to_string(light.size[0]) + " at " + std::to_string(light.position[2]);
}
}

TEST_F(LampBeams, ARectangleGivesEachVoxelItsRadianceTimesItsSolidAngle)
{
  for (const RectangleInBox& rectangle : Rectangles)
  {
    SCOPED_TRACE(NameOf(rectangle.light));
    Scene scene = VacuumAround(rectangle);
    const LightField found = scene.Solve(this->GetDevice());
    EXPECT_LT(found.balance.RelativeError(1), 1e-5);
    const RectangleSeen seen(rectangle.light);
    const double radiance = rectangle.light.power[0] / (Pi * rectangle.light.size[0] * rectangle.light.size[1]);
    const double least = 1e-3 * *std::max_element(found.fluence.begin(), found.fluence.end());
    for (std::size_t i = 0; i < found.fluence.size(); i += 13)
    {
      const std::array<int, 3> voxel = scene.medium.grid.VoxelAt(i);
      const glm::dvec3 edge = Vector(rectangle.spacing);
      const double exact = radiance * seen.Mean(edge * glm::dvec3(voxel[0], voxel[1], voxel[2]), edge, 3);
      EXPECT_NEAR(found.fluence[i], exact, 0.02 * std::max(exact, least))
        << voxel[0] << ' ' << voxel[1] << ' ' << voxel[2];
    }
  }
}

TEST_F(LampBeams, ARectanglesLightIsExtinguishedOnItsWay)
{
  constexpr double sigma = 0.3;
  double byDefault = 0.0, fine = 0.0; // mean squares of errors
  for (const int which : { 0, 2, 5, 7, 11 })
  {
    const Light& light = Rectangles[which].light;
    Scene scene({ 10, 10, 10 }, static_cast<float>(sigma));
    std::vector<std::vector<float>> found; // by quality
    for (const Quality quality : { Quality::Draft, Quality::Default, Quality::Fine })
    {
      scene.light.lights = { light };
      SetFineness(scene.light.lights, quality);
      const LightField solved = scene.Solve(this->GetDevice());
      EXPECT_LT(solved.balance.RelativeError(1), 1e-5) << which;
      found.push_back(solved.fluence);
    }
    const RectangleSeen seen(light);
    const double radiance = light.power[0] / (Pi * light.size[0] * light.size[1]);
    std::array<double, 3> squares = {};
    double count = 0.0;
    for (std::size_t i = 7; i < found[0].size(); i += 37)
    {
      const std::array<int, 3> voxel = scene.medium.grid.VoxelAt(i);
      constexpr int samples = 4000;
      double exact = 0.0;
      for (int s = 0; s < samples; ++s) // by solid angle
      {
        const auto unit = [s](int dimension) { // of an additive sequence of even points
          return std::fmod(0.5 + (s + 1.0) * std::pow(1.1347241384015194, -dimension), 1.0);
        };
        const glm::dvec3 to(voxel[0] + unit(1), voxel[1] + unit(2), voxel[2] + unit(3));
        if (seen.From(to) <= 0.0)
        {
          continue;
        }
        const glm::dvec3 first = 2.0 * seen.half.x * seen.axes[0], second = 2.0 * seen.half.y * seen.axes[1];
        const SphericalRectangle view(to, seen.middle - 0.5 * (first + second), first, second);
        const glm::dvec3 from = view.At(unit(4), unit(5)), way = to - from;
        double outside = 0.0; // part of the way
        for (int a = 0; a < 3; ++a)
        {
          outside = std::max(
            { outside, from[a] < 0.0 ? -from[a] / way[a] : 0.0, from[a] > 10.0 ? (10.0 - from[a]) / way[a] : 0.0 });
        }
        exact += radiance * view.SolidAngle() * std::exp(-sigma * glm::length(way) * (1.0 - outside)) / samples;
      }
      for (std::size_t q = 0; q < squares.size(); ++q)
      {
        squares[q] += exact > 0.0 ? std::pow(found[q][i] / exact - 1.0, 2.0) : found[q][i];
      }
      ++count;
    }
    EXPECT_LT(std::sqrt(squares[0] / count), 0.1) << which;
    EXPECT_LT(std::sqrt(squares[1] / count), 0.03) << which;
    byDefault += squares[1] / count;
    fine += squares[2] / count;
  }
  EXPECT_LT(fine, 0.5 * byDefault);
}

// By what shines on points of the box's faces.
TEST_F(LampBeams, OfARectanglesLightEntersWhatMeetsTheBox)
{
  for (const RectangleInBox& rectangle : Rectangles)
  {
    Scene scene = VacuumAround(rectangle);
    const double found = scene.Solve(this->GetDevice()).balance.entered[0] / rectangle.light.power[0];
    const double exact = RectangleSeen(rectangle.light).PartThatEnters(scene.medium.grid);
    EXPECT_NEAR(found / exact, 1.0, 1e-3) << NameOf(rectangle.light);
  }
}

TEST_F(LampBeams, ARectangleThatShinesOutAtThePeriodicEndOfAnAxisShinesInAtTheOther)
{
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2;
    const double end = UnevenLengths[axis];
    std::array<double, 3> position = { 3.3, 2.9, 3.6 }, out = {};
    out[axis] = face % 2 ? 1.0 : -1.0;
    for (bool all : { false, true })
    {
      std::array<bool, 3> periodic = { all, all, all };
      periodic[axis] = true;
      position[axis] = face % 2 ? end : 0.0;
      const LightField light = LitBy(this->GetDevice(), Rectangle(position, out, 2.0, 1.6), periodic);
      EXPECT_NEAR(light.balance.entered[0], 10.0, 1e-2) << face << all;
      position[axis] = face % 2 ? 1e-5 * end : (1.0 - 1e-5) * end;
      const LightField within = LitBy(this->GetDevice(), Rectangle(position, out, 2.0, 1.6), periodic);
      const double largest = *std::max_element(light.fluence.begin(), light.fluence.end());
      for (std::size_t i = 0; i < light.fluence.size(); ++i)
      {
        EXPECT_NEAR(light.fluence[i], within.fluence[i], 1e-3 * largest) << face << all << ' ' << i;
      }
    }
  }
}

TEST_F(LampBeams, ARectangleOverAllOfAPeriodicBoxShinesAsAPlane)
{
  Scene scene({ 6, 6, 5 });
  scene.settings.periodic = { true, true, false };
  scene.light.lights = { Rectangle({ 3.0, 3.0, 4.9 }, { 0.0, 0.0, -1.0 }, 6.0, 6.0) };
  const LightField found = scene.Solve(this->GetDevice());
  for (std::size_t i = 0; i < found.fluence.size(); ++i)
  {
    const double exact = 10.0 * 2.0 / 36.0 * (i / 36 == 4 ? 0.9 : 1.0); // what of the voxel is below the lamp
    EXPECT_NEAR(found.fluence[i], exact, 0.02 * exact) << i / 36;
  }
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
    EXPECT_LT(light.balance.leftOver[0], 5e-5 * light.balance.entered[0]) << box.size[2] << ' ' << box.tau;
    EXPECT_LT(light.balance.RelativeError(1), 1e-5) << box.size[2] << ' ' << box.tau;
    EXPECT_NEAR(light.balance.entered[0], 10.0, 1e-4);
  }
}

TEST_F(LampBeams, RoundThreePeriodicAxesLoseNothing)
{
  for (LightType type : { LightType::Point, LightType::Spot, LightType::Rectangle })
  {
    Scene scene({ 12, 9, 10 });
    scene.Randomise(0.1, 1.0, 0.0, 1);
    scene.settings.periodic = { true, true, true };
    scene.light.lights = { Lamp(type, { 4.9, 2.7, 7.7 }, 1.0) };
    const LightField light = scene.Solve(this->GetDevice());
    EXPECT_NEAR(light.balance.absorbed[0], 1.0, 1e-5) << static_cast<int>(type);
  }
  for (const float sigma_a : { 0.2f, 0.3f, 0.4f, 0.5f }) // the first pass takes nearly all of it
  {
    Scene scene({ 6, 6, 9 }, sigma_a);
    scene.settings.periodic = { true, true, true };
    scene.light.lights = { Lamp(LightType::Point, { 1.8, 3.6, 4.1 }, 1.0) };
    EXPECT_NEAR(scene.Solve(this->GetDevice()).balance.absorbed[0], 1.0, 1e-5) << sigma_a;
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
      EXPECT_NEAR(mean / exact, 1.0, 0.04) << n[2] << ": " << layer; // measured: 2.8%
    }
  }
}
