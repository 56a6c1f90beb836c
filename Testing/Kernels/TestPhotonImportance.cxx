#include "DeviceTest.h"
#include "Difference.h"
#include "ErrorWords.h"
#include "PhotonScene.h"

#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Importance/PhotonImportance.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
constexpr int Edge = 32;
constexpr double BallRadius = 0.5;

class PhotonImportance : public DeviceTest
{
protected:
  /// A ball of glass in thin fog, in a box of 2.
  PhotonImportance()
    : Ball(Edge, 1.0, 0.02f, 0.1f)
  {
    this->Ball.SetBall(BallRadius, 1.5);
  }

  /// A sun that shines straight down.
  static Illumination Sun(double power = 1.0)
  {
    Light sun;
    sun.type = LightType::Directional;
    sun.direction = { 0.0, 0.0, -1.0 };
    sun.power = { power, power, power };
    Illumination light;
    light.lights = { sun };
    return light;
  }

  static Light Lamp(std::array<double, 3> place, double power = 10.0)
  {
    Light lamp;
    lamp.type = LightType::Point;
    lamp.position = place;
    lamp.power = { power, power, power };
    return lamp;
  }

  Importance Find(PhotonScene& scene, const Illumination& light, const ImportanceSettings& settings = {})
  {
    PhotonMarcher marcher = scene.Marcher(this->GetDevice());
    return FindImportance(marcher, scene.medium.grid, light, settings);
  }

  PhotonScene Ball;
};

/// Mean density of the map in a ring about its middle, radii in map cells.
double MeanInRing(const ImportanceMap& map, double from, double to)
{
  double sum = 0.0;
  int cells = 0;
  for (int j = 0; j < map.size; ++j)
  {
    for (int i = 0; i < map.size; ++i)
    {
      const double r = std::hypot(i + 0.5 - 0.5 * map.size, j + 0.5 - 0.5 * map.size);
      if (r >= from && r < to)
      {
        sum += map.density[j * map.size + i];
        ++cells;
      }
    }
  }
  return sum / cells;
}

}

TEST_F(PhotonImportance, SendsPhotonsThroughTheGlassAndItsShadow)
{
  const Importance importance = this->Find(this->Ball, Sun());
  EXPECT_FALSE(importance.even);
  ASSERT_EQ(importance.map.size, 32);
  ASSERT_EQ(importance.map.lights, std::vector<int>{ 0 });
  const double ball = MeanInRing(importance.map, 0.0, 0.5 * BallRadius * 32),
               around = MeanInRing(importance.map, 12, 16);
  EXPECT_GT(ball, 2.0 * around);
  EXPECT_GT(around, 0.29); // the background
  const double mean = std::accumulate(importance.map.density.begin(), importance.map.density.end(), 0.0) / 1024;
  EXPECT_NEAR(mean, 1.0, 1e-5);
}

TEST_F(PhotonImportance, IsTheSameForAnyPowerOfTheLight)
{
  const Importance importance = this->Find(this->Ball, Sun());
  for (const double power : { 1e-30, 1e-6, 1e6, 1e30 })
  {
    const Importance scaled = this->Find(this->Ball, Sun(power));
    EXPECT_LT(LargestDifference(scaled.map.density, importance.map.density), 1e-6) << power;
    EXPECT_NEAR(scaled.gradientThreshold / importance.gradientThreshold / power, 1.0, 1e-5);
  }
}

TEST_F(PhotonImportance, OfEvenLightIsOneEverywhereAndSaysSo)
{
  PhotonScene fog(Edge, 1.0, 0.02f, 0.1f);
  const Importance importance = this->Find(fog, Sun());
  EXPECT_TRUE(importance.even);
  EXPECT_TRUE(std::all_of(
    importance.map.density.begin(), importance.map.density.end(), [](float density) { return density == 1.0f; }));
  ASSERT_FALSE(importance.leftOut.empty());
  EXPECT_NE(importance.leftOut.back().find("even"), std::string::npos);
}

TEST_F(PhotonImportance, OfThickEvenFogIsEvenToo)
{
  PhotonScene fog(Edge, 1.0, 0.5f, 2.0f); // five optical lengths: the far side is dark
  for (const std::size_t pilots : { 256, 1024, 4096 })
  {
    ImportanceSettings settings;
    settings.pilotCount = pilots;
    EXPECT_TRUE(this->Find(fog, Sun(), settings).even) << pilots;
  }
}

TEST_F(PhotonImportance, OfFogUnderASlantingSunOrALampIsEvenToo)
{
  PhotonScene fog(Edge, 1.0, 0.1f, 0.4f);
  for (const double slope : { 0.1, 0.6, 1.7 })
  {
    Illumination light = Sun();
    light.lights[0].direction = { -slope, 0.1, -1.0 };
    EXPECT_TRUE(this->Find(fog, light).even) << slope;
  }
  Illumination light;
  light.lights = { Lamp({ 0.7, 0.4, 4.0 }) };
  EXPECT_TRUE(this->Find(fog, light).even);
  light.lights = { Lamp({ 0.2, 0.1, 0.3 }) };
  EXPECT_TRUE(this->Find(fog, light).even);
}

TEST_F(PhotonImportance, TakesThresholdsOfItsUser)
{
  ImportanceSettings settings;
  settings.automatic = false;
  settings.gradientThreshold = 0.3;
  settings.luminanceThreshold = 0.2;
  const Importance importance = this->Find(this->Ball, Sun(), settings);
  EXPECT_EQ(importance.gradientThreshold, 0.3);
  int chosen = 0;
  for (std::size_t i = 0; i < importance.chosen.size(); ++i)
  {
    const bool lit = importance.pilot.count[i] > 0.0f;
    const bool wanted = lit && (importance.gradient[i] >= 0.3f || importance.pilot.fluence[i] <= 0.2f);
    EXPECT_EQ(importance.chosen[i] != 0.0f, wanted) << i;
    chosen += wanted ? 1 : 0;
  }
  EXPECT_GT(chosen, 10);
  settings.gradientThreshold = 1e30;
  settings.luminanceThreshold = 0.0;
  EXPECT_TRUE(this->Find(this->Ball, Sun(), settings).even);
}

TEST_F(PhotonImportance, OfOnePilotPhotonIsEven)
{
  ImportanceSettings settings;
  settings.pilotCount = 1;
  const Importance importance = this->Find(this->Ball, Sun(), settings);
  EXPECT_EQ(importance.map.density, std::vector<float>{ 1.0f });
}

TEST_F(PhotonImportance, HasASquareForEveryLight)
{
  Illumination light = Sun();
  light.lights.push_back(Lamp({ 3.0, 0.5, 0.2 }));
  light.lights.push_back(Lamp({ 0.0, 0.0, 0.9 }));
  light.sky = { 0.1, 0.1, 0.1 };
  const Importance importance = this->Find(this->Ball, light);
  EXPECT_EQ(importance.map.lights, (std::vector<int>{ 0, 1, 2, EnvironmentLight }));
  EXPECT_EQ(importance.map.density.size(), 4u * 1024u);
  EXPECT_TRUE(std::all_of(importance.map.density.begin(), importance.map.density.end(),
    [](float density) { return density >= 0.29f && density < 1e4f; }));
}

TEST_F(PhotonImportance, OfALightThatMissesIsEven)
{
  Light spot = Lamp({ 0.0, 0.0, 5.0 });
  spot.type = LightType::Spot;
  spot.direction = { 0.0, 0.0, 1.0 };
  spot.angle = 30.0;
  Illumination light;
  light.lights = { spot };
  const Importance importance = this->Find(this->Ball, light);
  EXPECT_TRUE(importance.even);
  EXPECT_NE(importance.leftOut.back().find("no pilot photon meets"), std::string::npos);
  EXPECT_EQ(*std::max_element(importance.pilot.fluence.begin(), importance.pilot.fluence.end()), 0.0f);
}

TEST_F(PhotonImportance, RefusesWhatMeansNothing)
{
  ImportanceSettings settings;
  settings.pilotCount = 0;
  EXPECT_NE(ErrorWords([&] { this->Find(this->Ball, Sun(), settings); }).find("pilot photons is 0"), std::string::npos);
  settings = {};
  settings.background = 0.0;
  EXPECT_NE(ErrorWords([&] { this->Find(this->Ball, Sun(), settings); }).find("background"), std::string::npos);
  settings = {};
  settings.cells = { 16, 0, 16 };
  EXPECT_NE(ErrorWords([&] { this->Find(this->Ball, Sun(), settings); }).find("axis 1"), std::string::npos);
  EXPECT_NE(ErrorWords([&] { this->Find(this->Ball, {}); }).find("No light shines"), std::string::npos);
}

/// The unfiltered light of adaptive photons is an unbiased estimate: over 64 seeds its mean in every octant is that of
/// photons spread evenly.
TEST_F(PhotonImportance, BiasesNothing)
{
  Illumination light;
  light.lights = { Lamp({ 0.7, 0.4, 4.0 }, 100.0) };
  PhotonMarcher marcher = this->Ball.Marcher(this->GetDevice());
  const Grid& grid = this->Ball.medium.grid;
  const Importance importance = FindImportance(marcher, grid, light);
  ASSERT_FALSE(importance.even);
  const auto octants = [&](const EmissionSettings& settings) {
    const PhotonLight marched = marcher.March(EmitPhotons(grid, light, settings).photons);
    std::array<double, 8> sums = {};
    for (std::size_t i = 0; i < marched.light.fluence.size(); ++i)
    {
      const std::size_t half = Edge / 2, x = i % Edge, y = i / Edge % Edge, z = i / (Edge * Edge);
      sums[(x / half) + 2 * (y / half) + 4 * (z / half)] += marched.light.fluence[i];
    }
    return sums;
  };
  const std::array<double, 8> even = octants({ 4000000, Sampler::Hammersley, 1 });
  std::array<double, 8> mean = {}, squares = {};
  constexpr int seeds = 64;
  for (int seed = 1; seed <= seeds; ++seed)
  {
    EmissionSettings settings = { 3000, Sampler::Hammersley, static_cast<std::uint64_t>(seed) };
    settings.map = &importance.map;
    settings.batches = 2;
    const std::array<double, 8> sums = octants(settings);
    for (int o = 0; o < 8; ++o)
    {
      mean[o] += sums[o] / seeds;
      squares[o] += sums[o] * sums[o] / seeds;
    }
  }
  for (int o = 0; o < 8; ++o)
  {
    const double error = std::sqrt(std::max(squares[o] - mean[o] * mean[o], 0.0) / (seeds - 1));
    EXPECT_NEAR(mean[o], even[o], 3.0 * error) << "octant " << o;
    EXPECT_LT(error, 1e-3 * even[o]) << "octant " << o; // so that the claim says something
  }
}
