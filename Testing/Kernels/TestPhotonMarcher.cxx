#include "DeviceTest.h"
#include "ErrorWords.h"
#include "MediumScene.h"
#include "PhotonScene.h"
#include "RectangleSeen.h"

#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Published/PublishedPhotons.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <string>

using namespace tyndall;

namespace
{
std::vector<Photon> Beam(const Grid& grid, std::array<double, 3> direction, std::size_t count,
  Sampler sampler = Sampler::Hammersley, Rgb irradiance = { 1.0, 1.0, 1.0 }, std::uint64_t seed = 0)
{
  Illumination light;
  Light sun;
  sun.direction = direction;
  sun.power = irradiance;
  light.lights = { sun };
  return EmitPhotons(grid, light, { count, sampler, seed }).photons;
}

double BalanceError(const PhotonLight& light)
{
  return light.light.balance.RelativeError(light.light.channels);
}

/// Every voxel an index of its own: nothing steeper can be given.
void JumbleIndex(PhotonScene& scene, const std::function<double(double)>& ofRandom)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  scene.SetIndex([&](double, double, double) { return ofRandom(uniform(random)); });
}

void ExpectPhysicalLight(const PhotonLight& light, const std::string& what)
{
  for (const float fluence : light.light.fluence)
  {
    ASSERT_TRUE(fluence >= 0.0f && std::isfinite(fluence)) << what << ": " << fluence;
  }
  EXPECT_LT(BalanceError(light), 1e-6) << what;
}

void Randomise(PhotonScene& scene, double thickest, double decades)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-decades, 0.0);
  for (std::size_t i = 0; i < scene.sigma_a.size(); ++i)
  {
    scene.sigma_a[i] = static_cast<float>(thickest * std::pow(10.0, exponent(random)));
    scene.sigma_s[i] = static_cast<float>(thickest * std::pow(10.0, exponent(random)));
  }
}
}

class PhotonMarcherTest : public DeviceTest
{
};

TEST_F(PhotonMarcherTest, ABeamFollowsTheExponentialAtAnyThickness)
{
  for (double tau : { 0.0, 1e-6, 0.01, 0.6, 3.0, 1e6 })
  {
    PhotonScene scene({ 8, 8, 8 }, 0.5, 2.0, static_cast<float>(0.25 * tau), static_cast<float>(1.75 * tau));
    const PhotonLight light =
      scene.March(this->GetDevice(), Beam(scene.medium.grid, { 0.0, 0.0, 1.0 }, 4096, Sampler::Grid));
    ASSERT_EQ(light.light.channels, 1);
    for (int k = 0; k < 8; ++k)
    {
      const double exact = std::exp(-tau * k) * (tau > 0.0 ? -std::expm1(-tau) / tau : 1.0);
      for (int column : { 0, 27, 63 })
      {
        EXPECT_NEAR(light.light.fluence[k * 64 + column], exact, 3e-6 * exact + 1e-11) << tau << ' ' << k;
      }
    }
    EXPECT_LT(BalanceError(light), 1e-6) << tau;
    EXPECT_NEAR(light.light.facePowerOut[5][0], 16.0 * std::exp(-8.0 * tau), 1e-4);
    EXPECT_NEAR(light.scattered[0], 0.875 * light.light.balance.absorbed[0], 1e-5);
  }
}

TEST_F(PhotonMarcherTest, FluenceDoesNotDependOnHowManyPhotonsCarryIt)
{
  PhotonScene scene({ 16, 16, 16 }, 0.125, 1.0, 0.3f, 0.5f);
  scene.SetBall(0.5, 1.4);
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  const double rich = scene.TotalPathPower(marcher.March(Beam(scene.medium.grid, { 0.3, 0.5, 0.8 }, 200000)));
  for (std::size_t count : { 500u, 5000u })
  {
    const double mean = scene.TotalPathPower(marcher.March(Beam(scene.medium.grid, { 0.3, 0.5, 0.8 }, count)));
    EXPECT_NEAR(mean / rich, 1.0, 0.02) << count;
  }
  // Of random photons, the mean of many poor estimates in a voxel is the rich one.
  const std::size_t voxel = (9 * 16 + 7) * 16 + 6;
  const float target = marcher.March(Beam(scene.medium.grid, { 0.3, 0.5, 0.8 }, 400000)).light.fluence[voxel];
  double sum = 0.0, squares = 0.0;
  const int runs = 200;
  for (int run = 0; run < runs; ++run)
  {
    const double value =
      marcher.March(Beam(scene.medium.grid, { 0.3, 0.5, 0.8 }, 300, Sampler::Random, { 1.0, 1.0, 1.0 }, run + 1))
        .light.fluence[voxel];
    sum += value / runs;
    squares += value * value / runs;
  }
  const double error = std::sqrt((squares - sum * sum) / runs);
  EXPECT_NEAR(sum, target, 3.5 * error);
  EXPECT_LT(error, 0.2 * target);
}

TEST_F(PhotonMarcherTest, PowerInIsPowerOut)
{
  for (double thickest : { 1e-3, 1.0, 1e3, 1e7 })
  {
    for (bool bends : { false, true })
    {
      for (std::size_t count : { 1u, 77u, 20000u })
      {
        PhotonScene scene({ 17, 18, 19 }, 0.1, 0.9, 0.0f, 0.0f);
        Randomise(scene, thickest, 6.0);
        if (bends)
        {
          scene.SetBall(0.5, 1.5);
        }
        const PhotonLight light = scene.March(this->GetDevice(), Beam(scene.medium.grid, { 0.2, -0.5, 0.8 }, count));
        EXPECT_LT(BalanceError(light), 1e-6) << thickest << ' ' << bends << ' ' << count;
        EXPECT_EQ(light.missed, 0u);
      }
    }
  }
}

TEST_F(PhotonMarcherTest, StaysConservativeWhereTheIndexJumps)
{
  for (int order : { 1, 2, 4 })
  {
    PhotonScene scene(32, 1.0, 0.1f, 0.0f);
    scene.settings.order = order;
    const std::vector<Photon> photons = Beam(scene.medium.grid, { 1.0, 0.0, 0.0 }, 2000);
    for (double highest : { 1.5, 2.4, 4.0 })
    {
      const std::string what = "order " + std::to_string(order) + ", up to " + std::to_string(highest);
      JumbleIndex(scene, [&](double x) { return x < 0.5 ? 1.0 : highest; });
      ExpectPhysicalLight(scene.March(this->GetDevice(), photons), what + ", two");
      JumbleIndex(scene, [&](double x) { return 1.0 + (highest - 1.0) * x; });
      ExpectPhysicalLight(scene.March(this->GetDevice(), photons), what + ", any");
      // The volume's faces cut a ball with a sharp border.
      scene.SetIndex([&](double x, double y, double z) { return std::hypot(x - 1.0, y, z) < 0.9 ? highest : 1.0; });
      ExpectPhysicalLight(scene.March(this->GetDevice(), photons), what + ", ball");
    }
    JumbleIndex(scene, [](double x) { return std::exp(6.0 * x - 3.0); });
    ExpectPhysicalLight(scene.March(this->GetDevice(), photons), "order " + std::to_string(order) + ", exponential");
  }
}

TEST_F(PhotonMarcherTest, PhotonsThatAreLostAreLeftOver)
{
  // A step that begins at the least index ends with a velocity that means nothing.
  PhotonScene scene(8, 1.0, 0.1f, 0.0f);
  scene.SetIndex([](double x, double, double) { return x < 0.0 ? 1e-6 : 1e6; });
  const std::vector<Photon> photons = Beam(scene.medium.grid, { 1.0, 0.0, 0.0 }, 1000);
  for (int order : { 1, 2, 4 })
  {
    scene.settings.order = order;
    const PhotonLight light = scene.March(this->GetDevice(), photons);
    ExpectPhysicalLight(light, "order " + std::to_string(order));
    if (order > 1) // Euler's velocity is over n, which is large where it ends
    {
      EXPECT_GT(light.light.balance.leftOver[0], 0.0) << order;
    }
  }
}

TEST_F(PhotonMarcherTest, ThinMediaTakeWhatIsDepositedInThem)
{
  for (int edge : { 128, 512, 2048 })
  {
    for (double depth : { 1e-7, 2e-6, 1e-5, 1e-3 })
    {
      const double sigma = depth / 0.25;
      PhotonScene scene({ edge, 4, 4 }, 0.25, 0.5, 0.0f, static_cast<float>(sigma));
      const PhotonLight light = scene.March(this->GetDevice(), Beam(scene.medium.grid, { 1.0, 0.0, 0.0 }, 3000));
      EXPECT_LT(BalanceError(light), 1e-6) << edge << " voxels of optical thickness " << depth;
      const double absorbed = light.light.balance.absorbed[0] / light.light.balance.entered[0];
      EXPECT_NEAR(absorbed, -std::expm1(-edge * depth), 5e-7) << edge << ' ' << depth;
    }
  }
}

TEST_F(PhotonMarcherTest, LightThatGoesRoundForEverIsLeftOver)
{
  PhotonScene scene(32, 2.0);
  scene.SetIndex([](double x, double y, double z) { return 2.0 / (1.0 + x * x + y * y + z * z); });
  Photon photon;
  photon.position = { 1.0, 0.0, 0.0 };
  photon.direction = { 0.0f, 1.0f, 0.0f };
  photon.power = { 1.0f, 1.0f, 1.0f };
  const PhotonLight light = scene.March(this->GetDevice(), { photon });
  EXPECT_EQ(light.light.balance.leftOver[0], 1.0);
  EXPECT_LT(BalanceError(light), 1e-6);
}

TEST_F(PhotonMarcherTest, AllPhotonsThroughOneVoxelLoseNothingAndThePublishedPackingDoes)
{
  PhotonScene scene({ 3, 3, 3 }, 1.0, 1.5, 0.05f, 0.15f);
  std::vector<Photon> photons(100000);
  for (Photon& photon : photons)
  {
    photon.position = { -1.5, 0.1, 0.1 };
    photon.direction = { 1.0f, 0.0f, 0.0f };
    photon.power = { 1e-5f, 1e-5f, 1e-5f };
  }
  for (MarchSettings::Sums sums : { MarchSettings::Sums::Shared, MarchSettings::Sums::Private })
  {
    scene.settings.sums = sums;
    const PhotonLight light = scene.March(this->GetDevice(), photons);
    EXPECT_LT(BalanceError(light), 1e-6);
    EXPECT_NEAR(light.light.balance.absorbed[0], -std::expm1(-0.6), 1e-5);
  }
  PackingLoss loss;
  const PhotonLight published = MarchPublished(
    this->GetDevice(), Domain(scene.medium.grid), scene.Medium(), scene.Index(), nullptr, photons, { false }, &loss);
  EXPECT_GT(loss.Relative(), 0.5);
  EXPECT_GT(BalanceError(published), 0.1);
  std::printf(
    "Published packing, 100000 photons through one voxel: %.1f %% of the power lost; %zu of %zu deposits given up\n",
    100.0 * loss.Relative(), loss.givenUp, loss.deposits);
}

TEST_F(PhotonMarcherTest, TheSumsDoNotDependOnWhoAdds)
{
  PhotonScene scene({ 24, 20, 28 }, 0.1, 1.2, 0.2f, 0.4f);
  scene.SetBall(0.7, 1.5);
  std::vector<Photon> photons = Beam(scene.medium.grid, { 0.1, 0.2, 1.0 }, 20000);
  scene.settings.sums = MarchSettings::Sums::Shared;
  const PhotonLight shared = scene.March(this->GetDevice(), photons);
  scene.settings.sums = MarchSettings::Sums::Private;
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  for (int run = 0; run < 3; ++run)
  {
    const PhotonLight light = marcher.March(photons);
    EXPECT_EQ(light.light.fluence, shared.light.fluence);
    EXPECT_EQ(light.meanDirection, shared.meanDirection);
    std::shuffle(photons.begin(), photons.end(), std::mt19937(run));
  }
}

TEST_F(PhotonMarcherTest, SharesSumsWhereTheBudgetHasNoRoomForPrivateOnes)
{
  PhotonScene scene({ 24, 20, 28 }, 0.1, 1.2, 0.2f, 0.4f);
  const std::vector<Photon> photons = Beam(scene.medium.grid, { 0.1, 0.2, 1.0 }, 2000);
  Device whole(this->GetDevice(), MemoryBudget{});
  scene.settings.sums = MarchSettings::Sums::Shared;
  const PhotonLight shared = scene.March(whole, photons);
  const std::size_t needed = whole.PeakBytes() + 64;
  scene.settings.sums = MarchSettings::Sums::Fitting;
  Device part(this->GetDevice(), MemoryBudget{ needed });
  EXPECT_EQ(scene.March(part, photons).light.fluence, shared.light.fluence);
  EXPECT_LE(part.PeakBytes(), needed);
  Device less(this->GetDevice(), MemoryBudget{ needed / 2 });
  EXPECT_THROW(scene.March(less, photons), DeviceError);
}

TEST_F(PhotonMarcherTest, ColourIsCarriedWhereItMatters)
{
  PhotonScene scene({ 6, 6, 6 }, 0.5, 1.5, 0.1f, 0.4f);
  const auto at = [&](const PhotonLight& light, int c) { return light.light.fluence[3 * 130 + c]; };
  const PhotonLight one =
    scene.March(this->GetDevice(), Beam(scene.medium.grid, { 0.0, 0.0, 1.0 }, 3600, Sampler::Grid, { 2.0, 1.0, 0.5 }));
  ASSERT_EQ(one.light.channels, 3);
  EXPECT_FLOAT_EQ(at(one, 0), 4.0f * at(one, 2));
  EXPECT_NEAR(one.light.balance.entered[0], 18.0, 1e-4);
  EXPECT_LT(BalanceError(one), 1e-6);

  std::vector<Photon> two = Beam(scene.medium.grid, { 0.0, 0.0, 1.0 }, 3600, Sampler::Grid, { 2.0, 0.0, 0.5 });
  const std::vector<Photon> green = Beam(scene.medium.grid, { 0.0, 0.0, 1.0 }, 3600, Sampler::Grid, { 0.0, 1.0, 0.0 });
  two.insert(two.end(), green.begin(), green.end());
  const PhotonLight mixed = scene.March(this->GetDevice(), two);
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(at(mixed, c), at(one, c), 1e-5f) << c;
  }

  std::vector<float> coloured;
  for (const float sigma : scene.sigma_a)
  {
    coloured.insert(coloured.end(), { sigma, 2.0f * sigma, 3.0f * sigma });
  }
  scene.sigma_a = coloured;
  const PhotonLight light =
    scene.March(this->GetDevice(), Beam(scene.medium.grid, { 0.0, 0.0, 1.0 }, 3600, Sampler::Grid));
  EXPECT_NEAR(at(light, 2) / at(light, 0),
    std::exp(-0.2 * 0.5 * 3) * (-std::expm1(-0.35) / 0.35) / (-std::expm1(-0.25) / 0.25), 1e-4);
  EXPECT_LT(BalanceError(light), 1e-6);
}

TEST_F(PhotonMarcherTest, ALargeRectangleGivesItsRadianceTimesItsSolidAngle)
{
  PhotonScene scene(4);
  const Grid& grid = scene.medium.grid;
  for (const double edge : { 200.0, 2e5 })
  {
    for (const std::array<double, 3>& direction : { std::array<double, 3>{ 0.0, 0.0, -1.0 }, { 0.4, 0.3, -1.0 } })
    {
      Light lamp;
      lamp.type = LightType::Rectangle;
      lamp.position = { 0.0, 0.0, 1.9 };
      lamp.direction = direction;
      lamp.size = { edge, edge };
      lamp.power = Times({ 1.0, 1.0, 1.0 }, Pi * edge * edge); // radiance 1
      Illumination light;
      light.lights = { lamp };
      const PhotonLight found = scene.March(this->GetDevice(), EmitPhotons(grid, light, { 50000 }).photons);
      double squares = 0.0;
      for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
      {
        const std::array<int, 3> voxel = grid.VoxelAt(i);
        const glm::dvec3 low = Vector(grid.origin) + Vector(grid.spacing) * glm::dvec3(voxel[0], voxel[1], voxel[2]);
        const double exact = RectangleSeen(lamp).Mean(low, Vector(grid.spacing), 2);
        squares += std::pow(found.light.fluence[i * found.light.channels] / exact - 1.0, 2.0) / grid.VoxelCount();
      }
      EXPECT_LT(std::sqrt(squares), 0.02) << edge << ' ' << direction[0];
    }
  }
}

TEST_F(PhotonMarcherTest, MeanDirectionIsWhereTheLightGoes)
{
  PhotonScene scene({ 8, 8, 8 }, 0.25, 1.0, 0.1f, 0.1f);
  std::vector<Photon> photons = Beam(scene.medium.grid, { 0.6, 0.0, 0.8 }, 5000);
  const std::vector<float> one = scene.March(this->GetDevice(), photons).meanDirection;
  const std::size_t voxel = (4 * 8 + 4) * 8 + 4;
  EXPECT_NEAR(one[3 * voxel], 0.6, 1e-5);
  EXPECT_NEAR(one[3 * voxel + 2], 0.8, 1e-5);
  const std::vector<Photon> back = Beam(scene.medium.grid, { -0.6, 0.0, -0.8 }, 5000);
  photons.insert(photons.end(), back.begin(), back.end());
  const std::vector<float> both = scene.March(this->GetDevice(), photons).meanDirection;
  EXPECT_LT(std::hypot(both[3 * voxel], both[3 * voxel + 2]), 0.15);
  scene.settings.meanDirection = false;
  EXPECT_TRUE(scene.March(this->GetDevice(), photons).meanDirection.empty());
}

TEST_F(PhotonMarcherTest, MeanDirectionIsNeverLongerThanOne)
{
  // Behind a thick wall a voxel gains a few units of power, and rounding of them counts.
  PhotonScene scene({ 32, 32, 32 }, 1.0, 16.0, 1.3f, 0.0f);
  for (const Rgb& colour : { Rgb{ 1.0, 1.0, 1.0 }, Rgb{ 1.0, 0.7, 0.2 } })
  {
    std::vector<Photon> photons = Beam(scene.medium.grid, { 0.3, 0.5, 0.8 }, 500, Sampler::Hammersley, colour);
    photons.front().power[1] *= 1.5f; // three channels then
    const std::vector<float> mean = scene.March(this->GetDevice(), photons).meanDirection;
    double longest = 0.0;
    for (std::size_t i = 0; i < mean.size(); i += 3)
    {
      longest = std::max(longest, std::hypot(double(mean[i]), double(mean[i + 1]), double(mean[i + 2])));
    }
    EXPECT_LE(longest, 1.0 + 1e-6);
    EXPECT_GT(longest, 0.999);
  }
}

TEST_F(PhotonMarcherTest, AnOctreeTakesFewerStepsToTheSameLight)
{
  PhotonScene scene(32, 1.0, 0.1f, 0.2f);
  scene.SetIndex(
    [](double x, double y, double z) { return 1.2 + 0.004 * x + 0.25 * std::erfc((std::hypot(x, y, z) - 0.4) / 0.1); });
  const std::vector<Photon> photons = Beam(scene.medium.grid, { 0.1, 0.2, 1.0 }, 20000);
  const PhotonLight fine = scene.March(this->GetDevice(), photons);
  // Nodes of 4^3 voxels in which the index hardly changes.
  scene.levels.assign(scene.medium.grid.VoxelCount(), 0);
  for (std::size_t i = 0; i < scene.levels.size(); ++i)
  {
    const std::size_t x = i % 32 / 4 * 4, y = i / 32 % 32 / 4 * 4, z = i / 1024 / 4 * 4;
    float low = 1e9f, high = 0.0f;
    for (int j = 0; j < 64; ++j)
    {
      const float n = scene.ior[((z + j / 16) * 32 + y + j / 4 % 4) * 32 + x + j % 4];
      low = std::min(low, n);
      high = std::max(high, n);
    }
    scene.levels[i] = high - low < 0.005f ? 2 : 0;
  }
  const PhotonLight coarse = scene.March(this->GetDevice(), photons);
  EXPECT_LT(coarse.steps, 0.7 * fine.steps);
  double difference = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < fine.light.fluence.size(); ++i)
  {
    difference += std::abs(fine.light.fluence[i] - coarse.light.fluence[i]);
    sum += fine.light.fluence[i];
  }
  EXPECT_LT(difference / sum, 0.01);
  EXPECT_LT(BalanceError(coarse), 1e-6);
}

TEST_F(PhotonMarcherTest, PhotonsThatMissAreCountedAndThoseOutsideAreMoved)
{
  PhotonScene scene({ 4, 4, 4 }, 0.5, 1.0, 0.0f, 0.0f);
  Photon hits, misses;
  hits.position = { 0.1, 0.1, -7.0 };
  misses.position = { 3.0, 0.1, -7.0 };
  hits.power = misses.power = { 1.0f, 1.0f, 1.0f };
  const PhotonLight light = scene.March(this->GetDevice(), { hits, misses });
  EXPECT_EQ(light.missed, 1u);
  EXPECT_NEAR(light.light.balance.entered[0], 1.0, 1e-6);
  EXPECT_NEAR(light.light.facePowerOut[5][0], 1.0, 1e-6);
  EXPECT_NEAR(scene.TotalPathPower(light), 2.0, 1e-5);
}

TEST_F(PhotonMarcherTest, WithoutPhotonsItIsDark)
{
  PhotonScene scene({ 4, 4, 4 }, 0.5, 1.0, 0.1f, 0.1f);
  const PhotonLight light = scene.March(this->GetDevice(), {});
  EXPECT_EQ(std::accumulate(light.light.fluence.begin(), light.light.fluence.end(), 0.0f), 0.0f);
  EXPECT_EQ(BalanceError(light), 0.0);
}

TEST_F(PhotonMarcherTest, RefusesWhatMeansNothing)
{
  PhotonScene scene({ 4, 4, 4 }, 0.5, 1.0, 0.1f, 0.1f);
  Photon photon;
  photon.power = { 1.0f, -1.0f, 0.0f };
  EXPECT_THROW(scene.March(this->GetDevice(), { photon }), InvalidInput);
  photon.power = { 1.0f, 1.0f, 1.0f };
  photon.direction = { 0.0f, 0.0f, 0.0f };
  EXPECT_THROW(scene.March(this->GetDevice(), { photon }), InvalidInput);
  for (double step : { 0.0, 0.049, 1e9 })
  {
    scene.settings.stepSize = step;
    EXPECT_THROW(scene.Marcher(this->GetDevice()), InvalidInput) << step;
  }
  scene.settings = {};
  scene.settings.order = 3;
  EXPECT_THROW(scene.Marcher(this->GetDevice()), InvalidInput);
  scene.settings = {};
  scene.SetIndex([](double x, double, double) { return x; });
  EXPECT_THROW(scene.Marcher(this->GetDevice()), InvalidInput);
  for (double index : { 1e-7, 1e7 })
  {
    scene.SetIndex([&](double x, double, double) { return x > 0.0 ? index : 1.0; });
    EXPECT_THROW(scene.Marcher(this->GetDevice()), InvalidInput) << index;
  }
}

TEST_F(PhotonMarcherTest, RefusesLevelsThatTheGridCannotHave)
{
  PhotonScene scene({ 16, 9, 4 }, 0.5, 1.0, 0.1f, 0.1f);
  scene.SetBall(0.5, 1.5);
  Photon photon;
  photon.power = { 1.0f, 1.0f, 1.0f };
  scene.levels.assign(scene.medium.grid.VoxelCount(), 4);
  EXPECT_NO_THROW(scene.Marcher(this->GetDevice()));
  scene.levels[16 * 9 + 16 + 3] = 5;
  const auto expectRefusal = [](const auto& march) {
    const std::string words = ErrorWords([&] { march(); });
    EXPECT_THAT(words, testing::HasSubstr("(3, 1, 1)"));
    EXPECT_THAT(words, testing::HasSubstr(" 5"));
  };
  expectRefusal([&] { scene.Marcher(this->GetDevice()); });
  expectRefusal([&] {
    MarchPublished(
      this->GetDevice(), Domain(scene.medium.grid), scene.Medium(), scene.Index(), scene.levels.data(), { photon }, {});
  });
}

TEST_F(PhotonMarcherTest, ReportsOftenWhereEveryVoxelBends)
{
  PhotonScene scene(64, 1.0, 0.0f, 0.1f);
  JumbleIndex(scene, [](double x) { return 1.0 + 0.2 * x; });
  scene.settings.stepSize = 0.1;
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  const std::vector<Photon> photons = Beam(scene.medium.grid, { 1.0, 0.0, 0.0 }, 60000);
  // Launches are shared out by the device's clock, here one by which each takes so long, however fast the machine is.
  const auto reportsWhereEachTakes = [&](double seconds) {
    double now = 0.0;
    this->GetDevice().SetClock([&] { return now; });
    int reports = 0;
    marcher.March(photons, [&](double) {
      now += seconds;
      ++reports;
      return true;
    });
    this->GetDevice().SetClock(ClockSeconds);
    return reports;
  };
  EXPECT_GE(reportsWhereEachTakes(0.1), 8) << "the first launch has a small part of the photons";
  EXPECT_GE(reportsWhereEachTakes(10.0), reportsWhereEachTakes(0.1)) << "too long: no launch is larger than the first";
  EXPECT_GE(reportsWhereEachTakes(0.0), 3) << "too short: the next one grows, but not to all that is left";
}

TEST_F(PhotonMarcherTest, StopsWhenItIsTold)
{
  PhotonScene scene({ 4, 4, 4 }, 0.5, 1.0, 0.1f, 0.1f);
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  const std::vector<Photon> photons = Beam(scene.medium.grid, { 0.0, 0.0, 1.0 }, 1000);
  EXPECT_THROW(marcher.March(photons, [](double) { return false; }), Aborted);
  EXPECT_EQ(marcher.March(photons).light.fluence, scene.March(this->GetDevice(), photons).light.fluence);
}

TEST_F(PhotonMarcherTest, ThePublishedSchemeGivesTheSameLightAlongAnAxis)
{
  PhotonScene scene({ 16, 16, 16 }, 0.125, 1.0, 0.2f, 0.3f);
  const std::vector<Photon> photons = Beam(scene.medium.grid, { 0.0, 0.0, 1.0 }, 256 * 4, Sampler::Grid);
  const PhotonLight conservative = scene.March(this->GetDevice(), photons);
  const PhotonLight published = MarchPublished(
    this->GetDevice(), Domain(scene.medium.grid), scene.Medium(), scene.Index(), nullptr, photons, { false });
  for (std::size_t i : { 100u, 1000u, 3000u })
  {
    EXPECT_NEAR(published.light.fluence[3 * i] / conservative.light.fluence[i], 1.0, 0.05);
    EXPECT_NEAR(published.meanDirection[3 * i + 2], 1.0, 0.01);
  }
}
