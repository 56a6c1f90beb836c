#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "Numerics/Constants.h"

#include "DeviceTest.h"
#include "MediumScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace tyndall;

namespace
{
/// A dim sky with one pixel of sun.
Environment SkyWithSun(float sky, float sun, int column, int row)
{
  Environment environment;
  environment.width = 128;
  environment.height = 64;
  environment.radiance.assign(3 * 128 * 64, sky);
  for (int c = 0; c < 3; ++c)
  {
    environment.radiance[3 * (row * 128 + column) + c] = sun * (c + 1);
  }
  return environment;
}

double Power(const Environment& environment, int channel)
{
  double sum = 0.0;
  for (int j = 0; j < environment.height; ++j)
  {
    const double solidAngle = (std::cos(Pi * j / environment.height) - std::cos(Pi * (j + 1) / environment.height)) *
      2.0 * Pi / environment.width;
    for (int i = 0; i < environment.width; ++i)
    {
      sum += solidAngle * environment.radiance[3 * (j * environment.width + i) + channel];
    }
  }
  return sum;
}
}

TEST(EnvironmentPeaks, TheSunBecomesALightAndNoPowerIsLost)
{
  const Environment environment = SkyWithSun(0.1f, 1e4f, 20, 48);
  const SplitEnvironment split = Split(environment, FittedDirections(25));
  ASSERT_EQ(split.peaks.size(), 1u);
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR((Power(split.smooth, c) + split.peaks[0].power[c]) / Power(environment, c), 1.0, 1e-6);
    EXPECT_GT(split.peaks[0].power[c], 0.5 * Power(environment, c));
  }
  EXPECT_NEAR(split.peaks[0].power[2] / split.peaks[0].power[0], 3.0, 1e-6) << "it keeps its colour";
  const std::array<double, 3>& d = split.peaks[0].direction;
  const double length = std::hypot(d[0], d[1], d[2]);
  const double polar = Pi * (1.0 - 48.5 / 64.0);
  EXPECT_NEAR(-d[2] / length, std::cos(polar), 1e-6) << "light travels from the sun";
  EXPECT_NEAR(std::atan2(-d[1], -d[0]), 2.0 * Pi * 20.5 / 128.0, 1e-6);
}

TEST(EnvironmentPeaks, AnUnevenSunShinesFromItsBrighterSide)
{
  Environment environment = SkyWithSun(0.1f, 3e4f, 20, 48);
  for (int c = 0; c < 3; ++c)
  {
    environment.radiance[3 * (48 * 128 + 21) + c] = 1e4f * (c + 1);
  }
  const SplitEnvironment split = Split(environment, FittedDirections(25));
  ASSERT_EQ(split.peaks.size(), 1u);
  const std::array<double, 3>& d = split.peaks[0].direction;
  EXPECT_NEAR(std::atan2(-d[1], -d[0]), 2.0 * Pi * 20.75 / 128.0, 1e-4);
}

TEST(EnvironmentPeaks, ASkyThatVariesSlowlyHasNone)
{
  Environment environment = SkyWithSun(1.0f, 1.0f, 0, 0);
  for (int j = 0; j < 64; ++j)
  {
    for (int i = 0; i < 3 * 128; ++i)
    {
      environment.radiance[3 * 128 * j + i] = 0.1f + j / 64.0f;
    }
  }
  const SplitEnvironment split = Split(environment, FittedDirections(25));
  EXPECT_TRUE(split.peaks.empty());
  EXPECT_EQ(split.smooth.radiance, environment.radiance);
  EXPECT_TRUE(Split(Environment(), FittedDirections(25)).peaks.empty());
}

namespace
{
/// A dim sky of 256 x 128 with a sun of `width` x `width` pixels, whose lowest row is `row`.
Environment HighSun(int width, int row)
{
  Environment environment;
  environment.width = 256;
  environment.height = 128;
  environment.radiance.assign(3 * 256 * 128, 0.1f);
  for (int j = row; j < row + width; ++j)
  {
    std::fill_n(environment.radiance.begin() + 3 * (256 * j + 40), 3 * width, 1e5f);
  }
  return environment;
}

/// What comes from everywhere, times where it comes from, as solvers have it along a set of directions: in the axes of
/// the environment's picture.
std::array<double, 3> PowerByDirection(const Environment& environment)
{
  const DirectionSet set = FittedDirections(25);
  const SplitEnvironment split = Split(environment, set);
  const std::vector<Rgb> smooth = BoundaryRadiance(set, split.smooth, {});
  std::array<double, 3> sum = {};
  const auto add = [&](const std::array<double, 3>& from, double power) {
    const std::array<double, 3> seen = environment.ToPicture(from);
    const double length = std::hypot(from[0], from[1], from[2]);
    for (int a = 0; a < 3; ++a)
    {
      sum[a] += power * seen[a] / length;
    }
  };
  for (const Light& peak : split.peaks)
  {
    add({ -peak.direction[0], -peak.direction[1], -peak.direction[2] }, peak.power[0]);
  }
  for (std::size_t d = 0; d < smooth.size(); ++d)
  {
    const std::array<double, 3>& omega = set.directions[d].omega;
    add({ -omega[0], -omega[1], -omega[2] }, set.directions[d].weight * smooth[d][0]);
  }
  return sum;
}
}

TEST(EnvironmentPeaks, HaveTheSamePowerByDirectionHoweverTheSkyStands)
{
  // At 30 and 87 degrees of elevation; a resampled sky had up to twice its power (one pixel: 0.42 to 5.4 times).
  struct Sun
  {
    int width, row;
  };
  for (const Sun& sun : { Sun{ 3, 85 }, Sun{ 3, 124 }, Sun{ 1, 126 } })
  {
    const Environment sky = HighSun(sun.width, sun.row);
    const std::array<double, 3> expected = PowerByDirection(sky);
    const double all = std::hypot(expected[0], expected[1], expected[2]);
    const Rotation oblique = { { { 0.6, 0.0, 0.8 }, { 0.48, 0.8, -0.36 }, { -0.64, 0.6, 0.48 } } };
    for (const Environment& turned : { Turned(sky, 0, 77.0), Turned(sky, oblique) })
    {
      const std::array<double, 3> found = PowerByDirection(turned);
      for (int a = 0; a < 3; ++a)
      {
        EXPECT_NEAR(found[a], expected[a], 1e-3 * all) << sun.width << " in row " << sun.row;
      }
    }
  }
}

class EnvironmentLight : public DeviceTest
{
};

TEST_F(EnvironmentLight, ASunInAPhotographCastsAShadowLikeADirectionalLight)
{
  // Behind an opaque plate, seen from a sun at the zenith's neighbour pixel, it is dark but for the sky.
  Scene scene({ 20, 20, 20 });
  for (int y = 7; y < 13; ++y)
  {
    for (int x = 7; x < 13; ++x)
    {
      scene.sigma_a[(static_cast<std::size_t>(15) * 20 + y) * 20 + x] = 1e6f;
    }
  }
  scene.light.environment = SkyWithSun(1e-6f, 1e6f, 20, 63);
  const LightField light = scene.Solve(this->GetDevice());
  const auto fluence = [&](int x, int z) {
    return light.fluence[((static_cast<std::size_t>(z) * 20 + 10) * 20 + x) * 3];
  };
  EXPECT_LT(fluence(10, 5), 1e-3 * fluence(2, 5)) << "shadow";
  EXPECT_NEAR(fluence(2, 5) / fluence(17, 5), 1.0, 1e-3) << "and even light beside it";
}
