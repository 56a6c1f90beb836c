#include "DeviceTest.h"
#include "Medium/Grid.h"
#include "PhotonScene.h"
#include "PhotonWays.h"

#include <gmock/gmock.h>

#include <numeric>

using namespace tyndall;

namespace
{
using Origins = std::vector<std::array<int, 2>>;

Origins AnyOrigins(std::size_t count, int last = 63)
{
  std::mt19937 random(5);
  std::uniform_int_distribution<int> place(0, last);
  Origins origins(count);
  for (auto& origin : origins)
  {
    origin = { place(random), place(random) };
  }
  return origins;
}

/// The cell of each voxel.
std::vector<std::size_t> CellsOf(const Grid& grid, const std::array<int, 3>& cells)
{
  std::vector<std::size_t> of;
  const auto along = [&](int a, int i) { return static_cast<std::size_t>(i * cells[a] / grid.size[a]); };
  ForGridVoxels(grid.size, [&](std::size_t, int i, int j, int k) {
    of.push_back((along(2, k) * cells[1] + along(1, j)) * cells[0] + along(0, i));
  });
  return of;
}

/// Count, and moments of the origins, by walks along paths.
struct Moments
{
  std::vector<double> count, mean, deviation;
};

Moments MomentsAlong(
  const std::vector<PhotonPath>& paths, const Origins& origins, const Grid& grid, const std::array<int, 3>& cells)
{
  const std::vector<std::size_t> cellOf = CellsOf(grid, cells);
  const std::size_t count = static_cast<std::size_t>(cells[0] * cells[1] * cells[2]);
  std::vector<std::vector<std::size_t>> photons(count);
  for (const PhotonPath& path : paths)
  {
    std::size_t last = count;
    for (const std::size_t voxel : VoxelsCrossed(path, grid))
    {
      if (cellOf[voxel] != last)
      {
        last = cellOf[voxel];
        photons[last].push_back(path.photon);
      }
    }
  }
  Moments moments;
  for (const std::vector<std::size_t>& own : photons)
  {
    moments.count.push_back(static_cast<double>(own.size()));
    for (int a = 0; a < 2; ++a)
    {
      double mean = 0.0, variance = 0.0;
      for (const std::size_t p : own)
      {
        mean += static_cast<double>(origins[p][a]) / own.size();
      }
      for (const std::size_t p : own)
      {
        variance += (origins[p][a] - mean) * (origins[p][a] - mean) / own.size();
      }
      moments.mean.push_back(mean);
      moments.deviation.push_back(std::sqrt(variance));
    }
  }
  return moments;
}

/// The mean of fluence over the voxels of each cell.
std::vector<double> MeanByCells(const PhotonLight& light, const Grid& grid, const std::array<int, 3>& cells)
{
  const std::vector<std::size_t> cellOf = CellsOf(grid, cells);
  const std::size_t channels = static_cast<std::size_t>(light.light.channels);
  std::vector<double> sum(cells[0] * cells[1] * cells[2] * channels, 0.0), voxels(sum.size(), 0.0);
  for (std::size_t i = 0; i < light.light.fluence.size(); ++i)
  {
    const std::size_t at = cellOf[i / channels] * channels + i % channels;
    sum[at] += light.light.fluence[i];
    ++voxels[at];
  }
  std::transform(sum.begin(), sum.end(), voxels.begin(), sum.begin(), std::divides<double>());
  return sum;
}

/// A medium whose extinction differs from voxel to voxel, thick in some.
PhotonScene Patchy(std::array<int, 3> size)
{
  PhotonScene scene(size, 0.1, 0.05 * size[0], 0.0f, 0.0f);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> exponent(-3.0f, 1.5f);
  for (float& sigma : scene.sigma_s)
  {
    sigma = std::pow(10.0f, exponent(random));
  }
  return scene;
}
}

class PilotLightTest : public DeviceTest
{
};

TEST_F(PilotLightTest, FluenceIsTheMeanOverItsVoxels)
{
  for (const bool coloured : { false, true })
  {
    for (const bool bends : { false, true })
    {
      PhotonScene scene = Patchy({ 20, 18, 23 });
      if (bends)
      {
        scene.SetBall(0.6, 1.4);
      }
      std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 4000);
      for (Photon& photon : photons)
      {
        photon.power[0] *= coloured ? 0.5f : 1.0f;
      }
      PhotonMarcher marcher = scene.Marcher(this->GetDevice());
      const PhotonLight fine = marcher.March(photons);
      // Dividing the voxels, not dividing them, one, as many, and more than there are.
      for (const std::array<int, 3>& cells :
        { std::array<int, 3>{ 5, 6, 23 }, { 7, 5, 6 }, { 1, 1, 1 }, { 20, 18, 23 }, { 100, 4, 16 } })
      {
        const std::array<int, 3> cut = { std::min(cells[0], 20), cells[1], cells[2] };
        const PilotLight pilot = marcher.Gather(photons, AnyOrigins(photons.size()), cells);
        EXPECT_EQ(pilot.grid.size, cut);
        ASSERT_EQ(pilot.channels, coloured ? 3 : 1);
        const std::vector<double> mean = MeanByCells(fine, scene.medium.grid, cut);
        ASSERT_EQ(pilot.fluence.size(), mean.size());
        for (std::size_t i = 0; i < mean.size(); ++i)
        {
          ASSERT_NEAR(pilot.fluence[i], mean[i], 1e-5 * mean[i] + 1e-9) << i;
        }
      }
      // And what was gathered is no part of what is marched next.
      EXPECT_EQ(marcher.March(photons).light.fluence, fine.light.fluence);
    }
  }
}

TEST_F(PilotLightTest, CellsFillTheMediumsBox)
{
  PhotonScene scene({ 10, 12, 9 }, 0.25, 1.0, 0.0f, 0.1f);
  const PilotLight pilot =
    scene.Marcher(this->GetDevice()).Gather(AnyPhotons(scene.medium.grid, 10), AnyOrigins(10), { 3, 4, 2 });
  for (int a = 0; a < 3; ++a)
  {
    EXPECT_EQ(pilot.grid.origin[a], scene.medium.grid.origin[a]);
    EXPECT_NEAR(pilot.grid.Length(a), scene.medium.grid.Length(a), 1e-12);
  }
}

TEST_F(PilotLightTest, CountsAndOriginsAreThoseOfAWalkAlongThePaths)
{
  for (const bool bends : { false, true })
  {
    PhotonScene scene({ 20, 18, 23 }, 0.1, 1.0, 0.02f, 0.05f);
    if (bends)
    {
      scene.SetBall(0.6, 1.4);
    }
    const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 2000);
    const Origins origins = AnyOrigins(photons.size());
    PhotonMarcher marcher = scene.Marcher(this->GetDevice());
    const std::array<int, 3> cells = { 7, 6, 8 };
    const PilotLight pilot = marcher.Gather(photons, origins, cells);
    const Moments moments = MomentsAlong(AllPaths(marcher, photons), origins, scene.medium.grid, cells);
    ASSERT_EQ(pilot.count.size(), moments.count.size());
    ASSERT_EQ(pilot.originMean.size(), moments.mean.size());
    ASSERT_EQ(pilot.originDeviation.size(), moments.mean.size());
    if (!bends)
    {
      EXPECT_THAT(pilot.count, testing::Pointwise(testing::Eq(), moments.count));
    }
    const double tolerance = bends ? 1e-4 : 1e-6;
    EXPECT_LT(DifferenceOf(pilot.count, moments.count), tolerance);
    EXPECT_LT(DifferenceOf(pilot.originMean, moments.mean), tolerance);
    EXPECT_LT(DifferenceOf(pilot.originDeviation, moments.deviation), tolerance);
  }
}

TEST_F(PilotLightTest, OriginsAreWholeUpToTheLast)
{
  PhotonScene scene({ 3, 3, 3 }, 1.0, 1.5, 0.0f, 0.1f);
  Photon photon;
  photon.position = { -1.5, 0.1, 0.1 };
  photon.direction = { 1.0f, 0.0f, 0.0f };
  photon.power = { 1.0f, 1.0f, 1.0f };
  const std::size_t count = 50000;
  Origins origins(count, { 65535, 0 });
  for (std::size_t i = 0; i < count; i += 2)
  {
    origins[i] = { 0, 65535 };
  }
  const PilotLight pilot =
    scene.Marcher(this->GetDevice()).Gather(std::vector<Photon>(count, photon), origins, { 3, 3, 3 });
  const std::size_t cell = (1 * 3 + 1) * 3 + 1;
  EXPECT_EQ(pilot.count[cell], static_cast<float>(count));
  for (int a = 0; a < 2; ++a)
  {
    EXPECT_FLOAT_EQ(pilot.originMean[2 * cell + a], 32767.5f);
    EXPECT_FLOAT_EQ(pilot.originDeviation[2 * cell + a], 32767.5f);
  }
  EXPECT_EQ(std::accumulate(pilot.count.begin(), pilot.count.end(), 0.0f), 3.0f * count);
}

TEST_F(PilotLightTest, OneNoneAndThoseThatMiss)
{
  PhotonScene scene({ 8, 8, 8 }, 0.25, 1.0, 0.0f, 0.1f);
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  Photon photon, beside;
  photon.position = { 0.1, 0.1, -1.0 };
  beside.position = { 5.0, 0.1, -1.0 };
  photon.power = beside.power = { 1.0f, 1.0f, 1.0f };
  const std::size_t cell = (1 * 2 + 1) * 2 + 1;
  const PilotLight one = marcher.Gather({ beside, photon }, { { 9, 9 }, { 7, 40 } }, { 2, 2, 2 });
  EXPECT_EQ(std::accumulate(one.count.begin(), one.count.end(), 0.0f), 2.0f);
  EXPECT_EQ(one.count[cell], 1.0f);
  EXPECT_EQ(one.originMean[2 * cell], 7.0f);
  EXPECT_EQ(one.originMean[2 * cell + 1], 40.0f);
  EXPECT_EQ(one.originDeviation[2 * cell], 0.0f);
  EXPECT_GT(one.fluence[cell], 0.0f);
  for (const PilotLight& none :
    { marcher.Gather({ beside }, { { 1, 2 } }, { 2, 2, 2 }), marcher.Gather({}, {}, { 2, 2, 2 }) })
  {
    for (const std::vector<float>& values : { none.fluence, none.count, none.originMean, none.originDeviation })
    {
      EXPECT_THAT(values, testing::Each(0.0f));
    }
  }
}

TEST_F(PilotLightTest, TheLightsPowerScalesFluenceOnly)
{
  PhotonScene scene(16, 1.0, 0.3f, 0.4f);
  scene.SetBall(0.6, 1.4);
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 1000);
  const Origins origins = AnyOrigins(photons.size());
  const PilotLight pilot = marcher.Gather(photons, origins, { 4, 4, 4 });
  for (const float scale : { 1e-6f, 1e6f })
  {
    std::vector<Photon> scaled = photons;
    for (Photon& photon : scaled)
    {
      for (float& power : photon.power)
      {
        power *= scale;
      }
    }
    const PilotLight other = marcher.Gather(scaled, origins, { 4, 4, 4 });
    EXPECT_EQ(other.count, pilot.count);
    EXPECT_EQ(other.originMean, pilot.originMean);
    EXPECT_EQ(other.originDeviation, pilot.originDeviation);
    for (std::size_t i = 0; i < pilot.fluence.size(); ++i)
    {
      ASSERT_NEAR(other.fluence[i] / scale, pilot.fluence[i], 1e-6 * pilot.fluence[i]);
    }
  }
}

TEST_F(PilotLightTest, RefusesWhatMeansNothing)
{
  PhotonScene scene({ 4, 4, 4 }, 0.5, 1.0, 0.1f, 0.1f);
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 3);
  const auto gather = [&](const Origins& origins, const std::array<int, 3>& cells) {
    return marcher.Gather(photons, origins, cells);
  };
  EXPECT_THROW(gather(AnyOrigins(2), { 2, 2, 2 }), InvalidInput);
  EXPECT_THROW(gather(AnyOrigins(3), { 2, 0, 2 }), InvalidInput);
  EXPECT_THROW(gather({ { 0, 0 }, { 0, 65536 }, { 0, 0 } }, { 2, 2, 2 }), InvalidInput);
  EXPECT_THROW(gather({ { 0, 0 }, { -1, 0 }, { 0, 0 } }, { 2, 2, 2 }), InvalidInput);
  EXPECT_THROW(marcher.Gather(photons, AnyOrigins(3), { 2, 2, 2 }, [](double) { return false; }), Aborted);
  EXPECT_NO_THROW(gather(AnyOrigins(3), { 2, 2, 2 }));
}
