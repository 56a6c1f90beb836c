// Photons that are scattered many times, against references that share no code with them.

#include "DeviceTest.h"
#include "Difference.h"
#include "MediumScene.h"
#include "RandomMedium.h"

#include "Numerics/Constants.h"
#include "Photons/Marching/PhotonMarcher.h"
#include "Photons/Scattering/PhotonScattering.h"
#include "Reference/CubeReference.h"
#include "Reference/ReferenceTable.h"
#include "Reference/SlabReference.h"
#include "Viewing/PictureError.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

using namespace tyndall;

namespace
{
/// Photons of 1 W together through the face -z of a box, cosine-distributed or along z.
std::vector<Photon> ThroughTheBottom(const Grid& grid, std::size_t count, bool diffuse, unsigned seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::vector<Photon> photons(count);
  for (Photon& photon : photons)
  {
    const double cosine = diffuse ? std::sqrt(even(random)) : 1.0, turn = 2.0 * Pi * even(random);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    photon.position = { grid.origin[0] + even(random) * grid.Length(0), grid.origin[1] + even(random) * grid.Length(1),
      grid.origin[2] };
    photon.direction = { static_cast<float>(sine * std::cos(turn)), static_cast<float>(sine * std::sin(turn)),
      static_cast<float>(cosine) };
    photon.power.fill(1.0f / static_cast<float>(count));
  }
  return photons;
}

Scene Cube(int edge, double tau, double albedo)
{
  Scene scene({ edge, edge, edge }, static_cast<float>(tau * (1.0 - albedo)), static_cast<float>(tau * albedo));
  scene.medium.grid.spacing = { 1.0 / edge, 1.0 / edge, 1.0 / edge };
  scene.Attach();
  return scene;
}

MarchSettings AllOrders(std::uint64_t seed = 7)
{
  MarchSettings settings;
  settings.maximumOrders = 0;
  settings.seed = seed;
  return settings;
}

double ErrorOf(double part, std::size_t photons)
{
  return std::sqrt(std::max(part * (1.0 - part), 1e-9) / static_cast<double>(photons));
}

}

class ScatteredPhotonsTest : public DeviceTest
{
protected:
  PhotonLight March(const Scene& scene, const std::vector<Photon>& photons, const MarchSettings& settings)
  {
    return PhotonMarcher(this->GetDevice(), Domain(scene.medium.grid), scene.medium, {}, settings).March(photons);
  }
};

TEST_F(ScatteredPhotonsTest, LeaveACubeAsTheReferencesDo)
{
  constexpr std::size_t Count = 150000;
  int beyond = 0;
  for (const bool forward : { false, true })
  {
    for (const ReferenceRow& cube : ReadReference(forward ? "cube_RTSA_anisotropic" : "cube_RTSA"))
    {
      if (cube["src"] > 1 || cube["tau"] > 10 || cube["slab"] != 0)
      {
        continue;
      }
      Scene scene = Cube(5, cube["tau"], cube["omega"]);
      scene.medium.phase = PhaseFunction::HenyeyGreenstein(cube["g"]);
      const auto photons = ThroughTheBottom(scene.medium.grid, Count, cube["src"] == 0, 20261123);
      const PhotonLight light = this->March(scene, photons, AllOrders());
      EXPECT_LT(light.light.balance.RelativeError(1), 1e-6);
      const std::array<Rgb, 6>& out = light.light.facePowerOut;
      const double found[4] = { out[4][0], out[5][0], out[0][0] + out[1][0] + out[2][0] + out[3][0],
        light.light.balance.absorbed[0] };
      const char* const names[4] = { "R", "T", "S", "A" };
      for (int part = 0; part < 4; ++part)
      {
        const double expected = cube[names[part]];
        const double error = std::hypot(ErrorOf(expected, Count), cube[std::string("s") + names[part]]);
        const double off = std::abs(found[part] - expected) / error;
        beyond += off > 3.0 ? 1 : 0;
        EXPECT_LT(off, 4.0) << names[part] << " tau " << cube["tau"] << " albedo " << cube["omega"] << " g "
                            << cube["g"] << ": " << found[part] << ", reference " << expected;
      }
    }
  }
  EXPECT_LE(beyond, 2); // of some hundred, where 0.3% are beyond 3 standard errors by chance
}

TEST_F(ScatteredPhotonsTest, AreScatteredAsOftenAsForecast)
{
  constexpr std::size_t Count = 4000; // few are scattered much more often than most
  for (const double tau : { 20.0, 100.0 })
  {
    for (const double albedo : { 1.0, 0.99 })
    {
      for (const double g : { 0.0, 0.85 })
      {
        for (const bool inside : { false, true })
        {
          Scene scene = Cube(6, tau, albedo);
          scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
          auto photons = ThroughTheBottom(scene.medium.grid, Count, true, 5);
          for (Photon& photon : photons)
          {
            photon.position[2] += inside ? 0.4 : 0.0;
          }
          const Domain domain(scene.medium.grid);
          const double forecast = ScatteringForecast(domain, scene.medium).Scatterings(domain, photons);
          const PhotonLight light = this->March(scene, photons, AllOrders());
          const double ratio = forecast * Count / static_cast<double>(light.scatterings);
          EXPECT_GT(ratio, 0.6) << tau << " " << albedo << " " << g << " " << inside;
          EXPECT_LT(ratio, 1.3) << tau << " " << albedo << " " << g << " " << inside;
        }
      }
    }
  }
}

TEST_F(ScatteredPhotonsTest, WarnBeforeTheyAreScatteredTooOften)
{
  const auto warning = [this](double tau, int orders) {
    const Scene scene = Cube(2, tau, 1.0);
    auto photons = ThroughTheBottom(scene.medium.grid, 10, false, 5);
    for (Photon& photon : photons)
    {
      photon.position[2] += 0.5;
    }
    MarchSettings settings;
    settings.maximumOrders = orders;
    return PhotonMarcher(this->GetDevice(), Domain(scene.medium.grid), scene.medium, {}, settings).Warning(photons);
  };
  EXPECT_NE(warning(1e4, 0).find("Uncollided Light"), std::string::npos) << warning(1e4, 0);
  EXPECT_EQ("", warning(1e2, 0));
  EXPECT_EQ("", warning(1e4, 1));
  EXPECT_EQ("", warning(1e4, 100));
}

TEST_F(ScatteredPhotonsTest, MakePicturesAsNoisyAsEstimated)
{
  for (const double tau : { 2.0, 12.0 })
  {
    Scene scene = Cube(16, tau, 0.9);
    Device& device = this->GetDevice();
    ViewSettings settings;
    settings.imageSize = { 60, 60 };
    settings.showBackground = false;
    const Camera camera = FrameGrid(scene.medium.grid, 1.0, 30.0, { 1.0, 0.5, 0.7 });
    std::vector<std::vector<float>> pictures;
    double estimate = 0.0;
    for (const std::size_t photons : { 10000u, 1000000u })
    {
      MarchSettings march = AllOrders();
      march.errorBatches = 16;
      const LightField found = this->March(scene, ThroughTheBottom(scene.medium.grid, photons, true, 3), march).light;
      SolvedLight light;
      light.fluence = { found.fluence.data(), 1 };
      light.fluenceError = { found.fluenceError.data(), 1 };
      light.errorLength = found.errorLength;
      Picture picture = MediumRayCaster(device, scene.medium, light, {}, settings).Render(camera);
      PictureErrorCasters(device, scene.medium, light, {}, settings).Estimate(picture, camera);
      estimate = pictures.empty() ? picture.relativeError : estimate;
      pictures.push_back(picture.radiance);
    }
    const double error = RelativeRmse(pictures[0], pictures[1]);
    EXPECT_GT(estimate / error, 0.6) << tau;
    EXPECT_LT(estimate / error, 1.7) << tau;
  }
}

TEST_F(ScatteredPhotonsTest, HaveTheFluenceOfACubeVoxelByVoxel)
{
  const CubeReference reference = CubeInDiffuseLight();
  const Scene scene = Cube(10, 1.0, 0.9);
  MarchSettings settings = AllOrders(20261123);
  settings.errorBatches = 64;
  const PhotonLight light = this->March(scene, ThroughTheBottom(scene.medium.grid, 400000, true, 5), settings);
  double square = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i)
  {
    const double error = std::hypot(light.light.fluenceError[i], reference[i].error);
    const double off = (light.light.fluence[i] - reference[i].fluence) / error;
    square += off * off / static_cast<double>(reference.size());
  }
  EXPECT_GT(square, 0.8);
  EXPECT_LT(square, 1.2);
}

TEST_F(ScatteredPhotonsTest, ReflectAndTransmitAsSlabsDo)
{
  constexpr std::size_t Count = 100000;
  for (const double tau : { 0.1, 1.0, 10.0 })
  {
    for (const double albedo : { 0.5, 0.9, 1.0 })
    {
      Scene scene({ 1, 1, 7 }, static_cast<float>(tau * (1.0 - albedo)), static_cast<float>(tau * albedo));
      scene.medium.grid.spacing = { 1e4, 1e4, 1.0 / 7.0 };
      scene.Attach();
      std::vector<Photon> photons = ThroughTheBottom(scene.medium.grid, Count, false, 3);
      for (Photon& photon : photons)
      {
        photon.position = { 5e3, 5e3, 0.0 };
      }
      const PhotonLight light = this->March(scene, photons, AllOrders());
      const SlabReference slab = SlabOf(tau, albedo);
      EXPECT_NEAR(light.light.facePowerOut[4][0], slab.beamR, 3.5 * ErrorOf(slab.beamR, Count)) << tau << " " << albedo;
      EXPECT_NEAR(light.light.facePowerOut[5][0], slab.beamT, 3.5 * ErrorOf(slab.beamT, Count)) << tau << " " << albedo;
    }
  }
}

TEST_F(ScatteredPhotonsTest, AreTheSameWhateverTheirOrder)
{
  Scene scene({ 6, 5, 7 }, 0.3f, 2.0f);
  scene.Randomise(3.0, 2.0, 0.9, 5);
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  scene.Attach();
  const std::vector<Photon> photons = ThroughTheBottom(scene.medium.grid, 3000, true, 9);
  const PhotonLight once = this->March(scene, photons, AllOrders()), again = this->March(scene, photons, AllOrders());
  EXPECT_EQ(once.light.fluence, again.light.fluence);
  EXPECT_EQ(once.meanDirection, again.meanDirection);
  EXPECT_EQ(once.scatterings, again.scatterings);
  EXPECT_NE(once.light.fluence, this->March(scene, photons, AllOrders(8)).light.fluence);
}

TEST_F(ScatteredPhotonsTest, OfOneOrderAreTheUncollidedLight)
{
  Scene scene({ 6, 5, 7 }, 0.3f, 2.0f);
  scene.Attach();
  const std::vector<Photon> photons = ThroughTheBottom(scene.medium.grid, 3000, true, 9);
  const PhotonLight one = this->March(scene, photons, {}), all = this->March(scene, photons, AllOrders());
  EXPECT_TRUE(one.light.fluenceDirect.empty());
  EXPECT_EQ(one.light.fluence, all.light.fluenceDirect);
}

TEST_F(ScatteredPhotonsTest, OfMoreOrdersAddUp)
{
  const Scene scene = Cube(4, 3.0, 0.95);
  const std::vector<Photon> photons = ThroughTheBottom(scene.medium.grid, 20000, true, 9);
  double last = 0.0;
  for (const int orders : { 1, 2, 3, 5, 20, 200 })
  {
    MarchSettings settings = AllOrders();
    settings.maximumOrders = orders;
    const PhotonLight light = this->March(scene, photons, settings);
    const double sum = std::accumulate(light.light.fluence.begin(), light.light.fluence.end(), 0.0);
    EXPECT_GE(sum, last * (1.0 - 1e-6)) << orders;
    EXPECT_LT(light.light.balance.RelativeError(1), 1e-6) << orders;
    EXPECT_EQ(light.light.balance.leftOver[0] > 0.01, orders > 1 && orders < 20) << orders;
    last = sum;
  }
  const PhotonLight all = this->March(scene, photons, AllOrders());
  EXPECT_NEAR(std::accumulate(all.light.fluence.begin(), all.light.fluence.end(), 0.0) / last, 1.0, 1e-6);
}

/// What Russian roulette gives it takes, in the mean: a medium that absorbs much is where it is played.
TEST_F(ScatteredPhotonsTest, PlayFairly)
{
  const Scene scene = Cube(3, 20.0, 0.6);
  const PhotonLight light =
    this->March(scene, ThroughTheBottom(scene.medium.grid, 200000, true, 2), AllOrders(20261123));
  EXPECT_NE(light.exchanged[0], 0.0);
  EXPECT_LT(std::abs(light.exchanged[0]), 4.0 * 0.05 / std::sqrt(200000.0));
  EXPECT_LT(light.light.balance.RelativeError(1), 1e-6);
}

// A path absorbs less than the last digit of a photon's power, so that nothing was subtracted from it.
TEST_F(ScatteredPhotonsTest, LoseWhatASinglePathHardlyAbsorbs)
{
  const Scene scene = Cube(3, 300.0, 1.0 - 3e-8);
  const EnergyBalance balance =
    this->March(scene, ThroughTheBottom(scene.medium.grid, 1000, true, 3), AllOrders()).light.balance;
  ASSERT_GT(balance.absorbed[0], 1e-6);
  EXPECT_NEAR(
    balance.absorbed[0] + balance.escaped[0] + balance.leftOver[0], balance.entered[0], 0.05 * balance.absorbed[0]);
}

TEST_F(ScatteredPhotonsTest, KeepColoursApart)
{
  Scene scene({ 4, 4, 4 }, 0.2f, 1.0f);
  scene.Attach();
  const std::vector<Photon> white = ThroughTheBottom(scene.medium.grid, 20000, true, 4);
  std::vector<Photon> red = white;
  for (Photon& photon : red)
  {
    photon.power[1] *= 0.5f;
    photon.power[2] = 0.0f;
  }
  const PhotonLight grey = this->March(scene, white, AllOrders()), found = this->March(scene, red, AllOrders());
  ASSERT_EQ(found.light.channels, 3);
  for (std::size_t i = 0; i < grey.light.fluence.size(); ++i)
  {
    EXPECT_NEAR(found.light.fluence[3 * i], grey.light.fluence[i], 1e-4 * grey.light.fluence[i]);
    EXPECT_NEAR(found.light.fluence[3 * i + 1], 0.5f * grey.light.fluence[i], 1e-4 * grey.light.fluence[i]);
    EXPECT_EQ(found.light.fluence[3 * i + 2], 0.0f);
  }
  // A coloured medium: each channel is the light of its own medium.
  Scene coloured({ 4, 4, 4 });
  for (std::size_t i = 0; i < grey.light.fluence.size(); ++i)
  {
    coloured.sigma_a[i] = 0.2f;
  }
  coloured.sigma_s.clear();
  for (std::size_t i = 0; i < grey.light.fluence.size(); ++i)
  {
    coloured.sigma_s.insert(coloured.sigma_s.end(), { 1.0f, 0.1f, 3.0f });
  }
  coloured.Attach();
  const PhotonLight three = this->March(coloured, white, AllOrders());
  double difference = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < grey.light.fluence.size(); ++i)
  {
    difference += std::abs(three.light.fluence[3 * i] - grey.light.fluence[i]);
    sum += grey.light.fluence[i];
  }
  EXPECT_LT(difference / sum, 1e-4);
  EXPECT_LT(three.light.balance.RelativeError(3), 1e-6);
}

TEST_F(ScatteredPhotonsTest, ErrAsOneOverTheRootOfTheirNumberOverFourDecades)
{
  const Scene scene = Cube(3, 2.0, 0.9);
  std::vector<double> errors;
  for (const std::size_t count : { 250, 2500, 25000, 250000, 2500000 })
  {
    MarchSettings settings = AllOrders();
    settings.errorBatches = 50;
    const PhotonLight light = this->March(scene, ThroughTheBottom(scene.medium.grid, count, true, 4), settings);
    double square = 0.0;
    for (float error : light.light.fluenceError)
    {
      square += static_cast<double>(error) * error;
    }
    errors.push_back(std::sqrt(square));
  }
  for (std::size_t i = 1; i < errors.size(); ++i)
  {
    EXPECT_NEAR(errors[i - 1] / errors[i], std::sqrt(10.0), 0.4);
  }
  EXPECT_NEAR(errors.front() / errors.back(), 100.0, 10.0);
}

/// Of 95 in 100 voxels the mean of many seeds lies within 1.96 standard errors.
TEST_F(ScatteredPhotonsTest, KnowTheirError)
{
  const Scene scene = Cube(4, 2.0, 0.9);
  constexpr int Seeds = 60;
  std::vector<std::vector<float>> scattered, errors;
  for (int seed = 0; seed < Seeds; ++seed)
  {
    MarchSettings settings = AllOrders(1000 + seed);
    settings.errorBatches = 64;
    PhotonLight light =
      this->March(scene, ThroughTheBottom(scene.medium.grid, 6400, true, 77 + static_cast<unsigned>(seed)), settings);
    scattered.push_back(light.light.fluence);
    errors.push_back(light.light.fluenceError);
  }
  int within = 0;
  for (std::size_t i = 0; i < scattered[0].size(); ++i)
  {
    double mean = 0.0;
    for (const std::vector<float>& one : scattered)
    {
      mean += one[i] / Seeds;
    }
    for (int seed = 0; seed < Seeds; ++seed)
    {
      within += std::abs(scattered[seed][i] - mean) < 1.96 * errors[seed][i] ? 1 : 0;
    }
  }
  const double part = within / static_cast<double>(Seeds * scattered[0].size());
  EXPECT_GT(part, 0.93);
  EXPECT_LT(part, 0.97);
}

TEST_F(ScatteredPhotonsTest, ReportAndStop)
{
  const Scene scene = Cube(8, 200.0, 1.0);
  const std::vector<Photon> photons = ThroughTheBottom(scene.medium.grid, 20000, true, 4);
  PhotonMarcher marcher(this->GetDevice(), Domain(scene.medium.grid), scene.medium, {}, AllOrders());
  double last = 0.0;
  int reports = 0;
  EXPECT_THROW(marcher.March(photons,
                 [&](double done) {
                   EXPECT_GE(done, last);
                   last = done;
                   return ++reports < 4;
                 }),
    Aborted);
  EXPECT_EQ(reports, 4);
}

TEST_F(ScatteredPhotonsTest, RefuseSettingsThatMeanNothing)
{
  const Scene scene = Cube(2, 1.0, 1.0);
  MarchSettings settings;
  settings.maximumOrders = -1;
  EXPECT_THROW(PhotonMarcher(this->GetDevice(), Domain(scene.medium.grid), scene.medium, {}, settings), InvalidInput);
  settings = AllOrders();
  settings.errorBatches = 65;
  EXPECT_THROW(PhotonMarcher(this->GetDevice(), Domain(scene.medium.grid), scene.medium, {}, settings), InvalidInput);
}

/// Sums in private copies or by atomics: who takes which photon, and when, makes no difference.
TEST_F(ScatteredPhotonsTest, AreTheSameHoweverTheyAreShared)
{
  if (!this->GetDevice().HasExtension("cl_khr_int64_base_atomics"))
  {
    GTEST_SKIP() << "no 64-bit atomics";
  }
  Scene scene({ 6, 5, 7 });
  scene.Randomise(3.0, 2.0, 0.9, 5);
  scene.Attach();
  const std::vector<Photon> photons = ThroughTheBottom(scene.medium.grid, 3000, true, 9);
  MarchSettings apart = AllOrders(), shared = AllOrders();
  apart.sums = MarchSettings::Sums::Private;
  shared.sums = MarchSettings::Sums::Shared;
  const PhotonLight one = this->March(scene, photons, apart), other = this->March(scene, photons, shared);
  if (!this->GetDevice().IsCpu()) // on which the compiler may round each of the two kernels in its own way
  {
    EXPECT_LT(RelativeRmse(one.light.fluence, other.light.fluence), 1e-6);
    EXPECT_LT(RelativeRmse(one.meanDirection, other.meanDirection), 1e-6);
    return;
  }
  EXPECT_EQ(one.light.fluence, other.light.fluence);
  EXPECT_EQ(one.meanDirection, other.meanDirection);
}

namespace
{
/// Photons of a furnace round a unit cube: radiance 1 from everywhere, through all its faces.
std::vector<Photon> FurnacePhotons(std::size_t throughEach, unsigned seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::vector<Photon> photons(6 * throughEach);
  for (std::size_t i = 0; i < photons.size(); ++i)
  {
    const std::size_t face = i % 6, a = face / 2, u = (a + 1) % 3, v = (a + 2) % 3;
    const double cosine = std::sqrt(even(random)), turn = 2.0 * Pi * even(random);
    const double sine = std::sqrt(1.0 - cosine * cosine);
    Photon& photon = photons[i];
    photon.position[a] = static_cast<double>(face % 2);
    photon.position[u] = even(random);
    photon.position[v] = even(random);
    photon.direction[a] = static_cast<float>(face % 2 ? -cosine : cosine);
    photon.direction[u] = static_cast<float>(sine * std::cos(turn));
    photon.direction[v] = static_cast<float>(sine * std::sin(turn));
    photon.power.fill(static_cast<float>(Pi / static_cast<double>(throughEach)));
  }
  return photons;
}

/// A glass ball in the middle of a unit cube: its index at a distance from the middle.
struct GlassBall
{
  double index;
  bool stepped;

  double At(double r) const
  {
    return 1.0 + (this->index - 1.0) * (this->stepped ? (r < 0.3 ? 1.0 : 0.0) : std::exp(-0.5 * r * r / (0.14 * 0.14)));
  }
};

/// Fluence over 4 pi n^2 of the voxels within a radius, and its standard error.
struct InFurnace
{
  double ratio, error;
};
}

class FurnaceOfPhotons : public DeviceTest
{
protected:
  InFurnace Within(const GlassBall& ball, double radius)
  {
    constexpr int Edge = 20, Parts = 16;
    Scene scene({ Edge, Edge, Edge }, 0.0f, 3.0f);
    scene.medium.grid.spacing = { 1.0 / Edge, 1.0 / Edge, 1.0 / Edge };
    scene.Attach();
    std::vector<float> ior;
    std::vector<double> expected;
    std::vector<bool> within;
    for (std::size_t i = 0; i < scene.medium.grid.VoxelCount(); ++i)
    {
      const auto distance = [&](double x, double y, double z) {
        return std::hypot(
          (i % Edge + x) / Edge - 0.5, (i / Edge % Edge + y) / Edge - 0.5, (i / Edge / Edge + z) / Edge - 0.5);
      };
      ior.push_back(static_cast<float>(ball.At(distance(0.5, 0.5, 0.5))));
      double mean = 0.0;
      for (int part = 0; part < 64; ++part)
      {
        const double n = ball.At(distance((part % 4 + 0.5) / 4, (part / 4 % 4 + 0.5) / 4, (part / 16 + 0.5) / 4));
        mean += n * n / 64;
      }
      expected.push_back(4.0 * Pi * mean);
      within.push_back(distance(0.5, 0.5, 0.5) < radius);
    }
    MarchSettings settings = AllOrders();
    std::vector<double> ratios; // of independent runs
    for (unsigned part = 0; part < Parts; ++part)
    {
      settings.seed = 100 + part;
      const PhotonLight light =
        PhotonMarcher(this->GetDevice(), Domain(scene.medium.grid), scene.medium, { ior.data(), 1 }, settings)
          .March(FurnacePhotons(2000, 20261123 + part));
      double found = 0.0, exact = 0.0;
      for (std::size_t i = 0; i < ior.size(); ++i)
      {
        found += within[i] ? light.light.fluence[i] : 0.0;
        exact += within[i] ? expected[i] : 0.0;
      }
      ratios.push_back(found / exact);
    }
    const double mean = std::accumulate(ratios.begin(), ratios.end(), 0.0) / Parts;
    double square = 0.0;
    for (double ratio : ratios)
    {
      square += (ratio - mean) * (ratio - mean) / (Parts - 1.0);
    }
    return { mean, std::sqrt(square / Parts) };
  }
};

/// A closed furnace: whatever bends and scatters, radiance is n^2 everywhere.
TEST_F(FurnaceOfPhotons, HasTheSquareOfTheIndex)
{
  for (const double index : { 1.5, 2.4 })
  {
    for (const bool stepped : { false, true })
    {
      const InFurnace found = this->Within({ index, stepped }, stepped ? 0.15 : 0.25);
      EXPECT_LT(std::abs(found.ratio - 1.0), 3.0 * found.error) << index << (stepped ? " stepped" : " smooth");
      EXPECT_LT(found.error, 0.01);
    }
  }
}
