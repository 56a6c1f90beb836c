#include "DeviceTest.h"
#include "ErrorWords.h"
#include "PhotonScene.h"
#include "PhotonWays.h"

#include <gmock/gmock.h>

#include <limits>
#include <string>

using namespace tyndall;

namespace
{
struct Counted
{
  std::vector<double> photons, weight; ///< their number, their mean weight
};

Counted CountAlong(const std::vector<PhotonPath>& paths, const std::vector<Photon>& photons, const Grid& grid)
{
  Counted counted;
  counted.photons.assign(grid.VoxelCount(), 0.0);
  counted.weight.assign(grid.VoxelCount(), 0.0);
  for (const PhotonPath& path : paths)
  {
    for (const std::size_t voxel : VoxelsCrossed(path, grid))
    {
      ++counted.photons[voxel];
      counted.weight[voxel] += photons[path.photon].weight;
    }
  }
  for (std::size_t i = 0; i < counted.weight.size(); ++i)
  {
    counted.weight[i] /= std::max(counted.photons[i], 1.0);
  }
  return counted;
}

std::vector<Photon> InBatches(std::vector<Photon> photons, int batches)
{
  for (std::size_t i = 0; i < photons.size(); ++i)
  {
    photons[i].batch = static_cast<int>(i) % batches;
  }
  return photons;
}

std::vector<MarchSettings::Sums> SumsOf(const Device& device)
{
  std::vector<MarchSettings::Sums> sums = { MarchSettings::Sums::Private };
  if (device.HasExtension("cl_khr_int64_base_atomics"))
  {
    sums.push_back(MarchSettings::Sums::Shared);
  }
  return sums;
}

std::vector<Photon> OfBatch(const std::vector<Photon>& photons, int batch)
{
  std::vector<Photon> own;
  std::copy_if(
    photons.begin(), photons.end(), std::back_inserter(own), [&](const Photon& p) { return p.batch == batch; });
  return own;
}

/// Three batches, of which one is empty, against marching each alone.
void ExpectLightOfEach(Device& device, PhotonScene& scene, bool coloured)
{
  const int batches = 3;
  std::vector<Photon> photons = InBatches(AnyPhotons(scene.medium.grid, 6000), batches);
  for (Photon& photon : photons)
  {
    photon.power[2] *= coloured ? 0.3f : 1.0f;
    photon.batch = photon.batch == 1 ? 2 : photon.batch;
  }
  const PhotonLight light = scene.March(device, photons);
  const std::size_t size = light.light.fluence.size();
  ASSERT_EQ(light.light.channels, coloured ? 3 : 1);
  ASSERT_EQ(light.batchFluence.size(), batches * size);
  for (int b = 0; b < batches; ++b)
  {
    const std::vector<Photon> own = OfBatch(photons, b);
    const std::size_t width = coloured ? 3 : 1;
    std::vector<float> part(size);
    for (std::size_t i = 0; i < size; ++i)
    {
      part[i] = light.batchFluence[(i / width * batches + static_cast<std::size_t>(b)) * width + i % width];
    }
    if (own.empty())
    {
      EXPECT_EQ(*std::max_element(part.begin(), part.end()), 0.0f);
      continue;
    }
    const std::vector<float> alone = scene.March(device, own).light.fluence;
    for (std::size_t i = 0; i < size; ++i)
    {
      ASSERT_NEAR(part[i], batches * alone[i], 2e-6 * batches * alone[i] + 1e-9) << b << ' ' << i;
    }
  }
}

template <class March>
void ExpectRefusal(const March& march, const std::string& words)
{
  EXPECT_THAT(ErrorWords(march), testing::HasSubstr(words));
}
}

class PhotonBatchesTest : public DeviceTest
{
};

TEST_F(PhotonBatchesTest, CountsAreThoseOfAWalkAlongStraightWays)
{
  PhotonScene scene({ 12, 9, 14 }, 0.1, 0.6, 0.02f, 0.05f);
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 1000);
  for (const MarchSettings::Sums sums : SumsOf(this->GetDevice()))
  {
    scene.settings.sums = sums;
    scene.settings.counts = true;
    PhotonMarcher marcher = scene.Marcher(this->GetDevice());
    const PhotonLight light = marcher.March(photons);
    const Counted counted = CountAlong(AllPaths(marcher, photons), photons, scene.medium.grid);
    ASSERT_EQ(light.photonCount.size(), counted.photons.size());
    for (std::size_t i = 0; i < counted.photons.size(); ++i)
    {
      ASSERT_EQ(light.photonCount[i], counted.photons[i]) << i;
      ASSERT_NEAR(light.photonWeight[i], counted.weight[i], 1e-4 * 4.0) << i;
    }
  }
}

TEST_F(PhotonBatchesTest, CountsAreThoseOfAWalkAlongBentWays)
{
  PhotonScene scene(24, 1.0, 0.02f, 0.05f);
  scene.SetBall(0.6, 1.4);
  scene.settings.counts = true;
  for (const double step : { 0.3, 1.0 }) // more turns than voxels; about as many
  {
    scene.settings.stepSize = step;
    const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 3000);
    PhotonMarcher marcher = scene.Marcher(this->GetDevice());
    const PhotonLight light = marcher.March(photons);
    const Counted counted = CountAlong(AllPaths(marcher, photons), photons, scene.medium.grid);
    EXPECT_LT(DifferenceOf(light.photonCount, counted.photons), 1e-4) << step;
    EXPECT_LT(DifferenceOf(light.photonWeight, counted.weight), 1e-4) << step;
  }
}

TEST_F(PhotonBatchesTest, APhotonFromAVoxelsCornerDoesNotCountBehindIt)
{
  PhotonScene scene({ 4, 4, 4 }, 0.5, 1.0, 0.0f, 0.0f);
  scene.settings.counts = true;
  Photon photon;
  photon.position = { 0.0, 0.0, 0.0 };
  photon.direction = { -0.48f, -0.6f, -0.64f };
  photon.power = { 1.0f, 1.0f, 1.0f };
  const PhotonLight light = scene.March(this->GetDevice(), { photon });
  EXPECT_EQ(light.photonCount[(2 * 4 + 2) * 4 + 2], 0.0f);
  EXPECT_EQ(light.photonCount[(1 * 4 + 1) * 4 + 1], 1.0f);
}

TEST_F(PhotonBatchesTest, CountsLeaveTheLightAsItIs)
{
  PhotonScene scene(20, 1.0, 0.2f, 0.5f);
  scene.SetBall(0.6, 1.4);
  std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 5000);
  for (const bool coloured : { false, true })
  {
    photons.front().power[1] *= coloured ? 2.0f : 1.0f; // three channels
    for (const bool direction : { false, true })
    {
      scene.settings.meanDirection = direction;
      scene.settings.counts = false;
      const PhotonLight without = scene.March(this->GetDevice(), photons);
      scene.settings.counts = true;
      ExpectSameLight(scene.March(this->GetDevice(), photons), without);
      EXPECT_TRUE(without.photonCount.empty());
      EXPECT_TRUE(without.photonWeight.empty());
    }
  }
}

TEST_F(PhotonBatchesTest, BatchesAddUpToTheLightWithoutThem)
{
  PhotonScene scene({ 20, 17, 22 }, 0.1, 1.0, 0.2f, 0.5f);
  scene.SetBall(0.6, 1.4);
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 20000);
  const PhotonLight whole = scene.March(this->GetDevice(), photons);
  scene.settings.counts = true;
  const PhotonLight counted = scene.March(this->GetDevice(), photons);
  scene.settings.batches = true;
  for (const MarchSettings::Sums sums : SumsOf(this->GetDevice()))
  {
    scene.settings.sums = sums;
    PhotonMarcher marcher = scene.Marcher(this->GetDevice());
    for (const int batches : { 5, 1, 2, 3, 2 })
    {
      const PhotonLight light = marcher.March(InBatches(photons, batches));
      ExpectSameLight(light, whole);
      EXPECT_EQ(light.photonCount, counted.photonCount);
      EXPECT_EQ(light.photonWeight, counted.photonWeight);
      EXPECT_EQ(light.batches, batches);
      const std::size_t voxels = whole.light.fluence.size();
      ASSERT_EQ(light.batchFluence.size(), voxels * static_cast<std::size_t>(batches));
      std::vector<double> mean(voxels, 0.0);
      for (std::size_t i = 0; i < light.batchFluence.size(); ++i)
      {
        mean[i / static_cast<std::size_t>(batches)] += static_cast<double>(light.batchFluence[i]) / batches;
      }
      for (std::size_t i = 0; i < voxels; ++i)
      {
        ASSERT_NEAR(mean[i], whole.light.fluence[i], 3e-7 * whole.light.fluence[i]) << batches << ' ' << i;
      }
    }
  }
}

TEST_F(PhotonBatchesTest, ABatchIsTheLightOfItsPhotons)
{
  PhotonScene scene(16, 1.0, 0.1f, 0.4f);
  scene.SetBall(0.6, 1.4);
  scene.settings.batches = true;
  for (const MarchSettings::Sums sums : SumsOf(this->GetDevice()))
  {
    scene.settings.sums = sums;
    ExpectLightOfEach(this->GetDevice(), scene, false);
    ExpectLightOfEach(this->GetDevice(), scene, true);
  }
}

TEST_F(PhotonBatchesTest, NotAskedForTheyMakeNoDifference)
{
  PhotonScene scene(10, 1.0, 0.1f, 0.4f);
  std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 300);
  const PhotonLight plain = scene.March(this->GetDevice(), photons);
  photons = InBatches(photons, 4);
  photons.front().batch = 1000;
  const PhotonLight light = scene.March(this->GetDevice(), photons);
  ExpectSameLight(light, plain);
  EXPECT_TRUE(light.batchFluence.empty());
  EXPECT_EQ(light.batches, 1001);
}

TEST_F(PhotonBatchesTest, TheLightsPowerChangesNoCount)
{
  PhotonScene scene(16, 1.0, 0.3f, 0.4f);
  scene.SetBall(0.6, 1.4);
  scene.settings.counts = scene.settings.batches = true;
  const std::vector<Photon> photons = InBatches(AnyPhotons(scene.medium.grid, 4000), 2);
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  const PhotonLight light = marcher.March(photons);
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
    const PhotonLight other = marcher.March(scaled);
    EXPECT_EQ(other.photonCount, light.photonCount);
    EXPECT_EQ(other.photonWeight, light.photonWeight);
    for (std::size_t i = 0; i < light.light.fluence.size(); ++i)
    {
      ASSERT_NEAR(other.light.fluence[i] / scale, light.light.fluence[i], 2e-6 * light.light.fluence[i]);
    }
  }
}

TEST_F(PhotonBatchesTest, ManyFewAndNoPhotonsCount)
{
  PhotonScene scene({ 5, 1, 1 }, 1.0, 0.5, 0.0f, 0.1f);
  scene.settings.counts = scene.settings.batches = true;
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  Photon photon;
  photon.position = { -2.0, 0.0, 0.0 };
  photon.direction = { 1.0f, 0.0f, 0.0f };
  photon.power = { 1.0f, 1.0f, 1.0f };
  photon.weight = 3.0f;
  Photon beside = photon;
  beside.position[1] = 7.0;
  for (const std::size_t count : { 100000u, 1u, 0u })
  {
    std::vector<Photon> photons = InBatches(std::vector<Photon>(count, photon), 2);
    photons.push_back(beside);
    const PhotonLight light = marcher.March(photons);
    EXPECT_THAT(light.photonCount, testing::Each(static_cast<float>(count)));
    EXPECT_THAT(light.photonWeight, testing::Each(count > 0 ? 3.0f : 0.0f));
    EXPECT_EQ(light.missed, 1u);
  }
  EXPECT_THAT(marcher.March({}).photonCount, testing::Each(0.0f));
  photon.weight = 0.0f;
  EXPECT_THAT(marcher.March({ photon }).photonWeight, testing::Each(0.0f));
}

TEST_F(PhotonBatchesTest, RefusesWhatMeansNothing)
{
  PhotonScene scene({ 4, 4, 4 }, 0.5, 1.0, 0.1f, 0.1f);
  scene.settings.batches = true;
  PhotonMarcher marcher = scene.Marcher(this->GetDevice());
  for (const int batch : { -1, 64 })
  {
    std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 5);
    photons[3].batch = batch;
    ExpectRefusal([&] { marcher.March(photons); }, "Photon 3 is of batch " + std::to_string(batch));
  }
  for (const float weight : { -1.0f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN() })
  {
    std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 5);
    photons[2].weight = weight;
    ExpectRefusal([&] { marcher.March(photons); }, "Photon 2 has weight");
  }
}
