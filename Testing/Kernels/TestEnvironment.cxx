#include "Device/Errors.h"
#include "Lights/Lights.h"
#include "Numerics/Constants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace tyndall;

namespace
{
/// Radiance that grows evenly towards the zenith and about it, so that every direction looks different.
Environment Gradient(int width, int height)
{
  Environment environment;
  environment.width = width;
  environment.height = height;
  for (int j = 0; j < height; ++j)
  {
    for (int i = 0; i < width; ++i)
    {
      const double polar = Pi * (1.0 - (j + 0.5) / height);
      const double azimuth = 2.0 * Pi * (i + 0.5) / width;
      const std::array<double, 3> to = { std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
        std::cos(polar) };
      for (double component : to)
      {
        environment.radiance.push_back(static_cast<float>(2.0 + component));
      }
    }
  }
  return environment;
}

void ExpectSeen(
  const Environment& environment, const std::array<double, 3>& along, const Rgb& expected, double tolerance)
{
  const Rgb seen = Lookup(environment, along);
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(seen[c], expected[c], tolerance) << "channel " << c;
  }
}
}

TEST(Environment, IsSeenWhereItsPixelsLook)
{
  const Environment environment = Gradient(256, 128);
  for (const std::array<double, 3>& along :
    { std::array<double, 3>{ 0.6, 0.0, 0.8 }, { 0.6, -0.64, 0.48 }, { -0.36, 0.48, -0.8 }, { 1.0, 0.0, 0.0 } })
  {
    ExpectSeen(environment, along, { 2.0 + along[0], 2.0 + along[1], 2.0 + along[2] }, 1e-3);
  }
}

TEST(Environment, IsClosedAroundAndAtThePoles)
{
  const Environment environment = Gradient(64, 32);
  ExpectSeen(environment, { 1.0, 1e-6, 0.0 }, Lookup(environment, { 1.0, -1e-6, 0.0 }), 1e-4);
  ExpectSeen(environment, { 0.0, 0.0, 1.0 }, { 2.0, 2.0, 3.0 }, 0.06);
  ExpectSeen(environment, { 0.0, 0.0, -1.0 }, { 2.0, 2.0, 1.0 }, 0.06);
}

TEST(TurnedEnvironment, TurnsAboutItsUp)
{
  const Environment turned = Turned(Gradient(256, 128), 2, 90.0);
  ExpectSeen(turned, { 0.0, 1.0, 0.0 }, { 3.0, 2.0, 2.0 }, 1e-3); // what stood along +x
  ExpectSeen(turned, { -1.0, 0.0, 0.0 }, { 2.0, 3.0, 2.0 }, 1e-3);
}

TEST(TurnedEnvironment, ComesBackAfterAFullTurn)
{
  const Environment environment = Gradient(60, 30);
  EXPECT_EQ(Turned(environment, 2, 360.0).radiance, environment.radiance);
  EXPECT_EQ(Turned(Turned(environment, 2, -30.0), 2, 30.0).radiance, environment.radiance);
}

TEST(TurnedEnvironment, StandsUpAlongEveryAxis)
{
  const Environment environment = Gradient(256, 128);
  ExpectSeen(Turned(environment, 0, 0.0), { 1.0, 0.0, 0.0 }, { 2.0, 2.0, 3.0 }, 0.02); // its zenith
  ExpectSeen(Turned(environment, 0, 0.0), { 0.0, 1.0, 0.0 }, { 3.0, 2.0, 2.0 }, 2e-3); // its +x
  ExpectSeen(Turned(environment, 1, 0.0), { 0.0, 1.0, 0.0 }, { 2.0, 2.0, 3.0 }, 0.02);
  ExpectSeen(Turned(environment, 1, 0.0), { 0.0, 0.0, 1.0 }, { 3.0, 2.0, 2.0 }, 0.02);
}

TEST(TurnedEnvironment, KeepsItsPixels)
{
  const Environment environment = Gradient(60, 30);
  for (int up = 0; up < 3; ++up)
  {
    EXPECT_EQ(Turned(environment, up, 123.4).radiance, environment.radiance);
  }
}

TEST(TurnedEnvironment, TurnsByAnyMatrix)
{
  const Environment environment = Gradient(256, 128);
  const Rotation turn = { { { 0.6, 0.0, 0.8 }, { 0.48, 0.8, -0.36 }, { -0.64, 0.6, 0.48 } } };
  const Rotation mirror = { { { 0.0, 1.0, 0.0 }, { 1.0, 0.0, 0.0 }, { 0.0, 0.0, -1.0 } } };
  for (const Rotation& matrix : { turn, mirror })
  {
    const std::array<double, 3> before = { 0.36, -0.48, 0.8 };
    std::array<double, 3> after = {};
    for (int row = 0; row < 3; ++row)
    {
      for (int column = 0; column < 3; ++column)
      {
        after[row] += matrix[row][column] * before[column];
      }
    }
    const Environment turned = Turned(environment, matrix);
    ExpectSeen(turned, after, Lookup(environment, before), 1e-9);
    const std::array<double, 3> there = turned.ToScene(turned.ToPicture(after));
    for (int a = 0; a < 3; ++a)
    {
      EXPECT_NEAR(there[a], after[a], 1e-12);
    }
  }
}

TEST(TurnedEnvironment, SaysWhatItCannotDo)
{
  const Environment environment = Gradient(8, 4);
  EXPECT_THROW(Turned(environment, 3, 0.0), InvalidInput);
  EXPECT_THROW(Turned(environment, 2, std::numeric_limits<double>::quiet_NaN()), InvalidInput);
  EXPECT_THROW(Turned(environment, { { { 1.0, 0.1, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } } }), InvalidInput);
  EXPECT_TRUE(Turned(Environment(), 1, 30.0).Empty());
}
