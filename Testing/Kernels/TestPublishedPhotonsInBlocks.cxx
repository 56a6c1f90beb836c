// Photons as published through a medium that is spread over ranks, against those through the whole on one.
//
// Light of photons whose powers are all 1 is compared bit for bit: RGBe has whole numbers up to 256. Of others the
// packing loses what the order of deposits makes it lose, on one rank as on several.

#include "BlocksOfScene.h"
#include "DeviceTest.h"
#include "PhotonWays.h"

#include "Photons/Published/PublishedPhotons.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
/// Of the same power, which nothing takes from them.
std::vector<Photon> WholePhotons(PhotonScene& scene, std::size_t count)
{
  std::fill(scene.sigma_a.begin(), scene.sigma_a.end(), 0.0f);
  std::fill(scene.sigma_s.begin(), scene.sigma_s.end(), 0.0f);
  std::vector<Photon> photons = AnyPhotons(scene.medium.grid, count);
  for (Photon& photon : photons)
  {
    photon.power.fill(1.0f);
  }
  return photons;
}

/// To rounding of sums over photons and voxels.
void ExpectSamePowers(const Rgb& found, const Rgb& expected, const char* what)
{
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(found[c], expected[c], 1e-12 * expected[c]) << what;
  }
}
}

class PublishedPhotonBlocks : public DeviceTest
{
protected:
  struct Found
  {
    PhotonLight light;
    PackingLoss loss;
  };

  Found OnOne(PhotonScene& scene, const std::vector<Photon>& photons)
  {
    Found found;
    found.light = MarchPublished(GetDevice(), scene.Medium(), scene.Index(),
      scene.levels.empty() ? nullptr : scene.levels.data(), photons, {}, &found.loss);
    return found;
  }

  Found OnRanks(const PhotonScene& scene, const BlockPartition& partition, const std::vector<Photon>& photons,
    std::vector<RoundsTraffic>* traffic = nullptr)
  {
    std::mutex guard;
    Found found;
    const auto march = [&](Communicator& communicator, const BlockOfScene& part, const std::vector<Photon>& share,
                         RoundsTraffic& handed) {
      PackingLoss loss;
      PhotonLight light = MarchPublishedInBlocks(
        GetDevice(), communicator, partition, part.medium, part.Index(), part.Levels(), share, {}, &loss, {}, &handed);
      const std::lock_guard<std::mutex> lock(guard);
      found.loss = loss;
      return light;
    };
    found.light = LightOfAll(scene, partition, photons, march, traffic);
    return found;
  }

  /// Steps, deposits, what they leave and what is left of them.
  static void ExpectSameWays(const Found& found, const Found& expected)
  {
    EXPECT_EQ(found.light.steps, expected.light.steps);
    EXPECT_EQ(found.light.deposits, expected.light.deposits);
    EXPECT_EQ(found.loss.deposits, expected.loss.deposits);
    EXPECT_EQ(found.light.missed, expected.light.missed);
    EXPECT_EQ(found.light.light.balance.entered, expected.light.light.balance.entered);
    ExpectSamePowers(found.loss.deposited, expected.loss.deposited, "deposited");
    ExpectSamePowers(found.light.light.balance.escaped, expected.light.light.balance.escaped, "escaped");
    ExpectSamePowers(found.light.light.balance.leftOver, expected.light.light.balance.leftOver, "left over");
    for (std::size_t face = 0; face < 6; ++face)
    {
      ExpectSamePowers(found.light.light.facePowerOut[face], expected.light.light.facePowerOut[face], "out of a face");
    }
  }

  static double FurthestOf(const std::vector<float>& found, const std::vector<float>& expected)
  {
    double most = found.size() == expected.size() ? 0.0 : 1e9;
    for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i)
    {
      most = std::max(most, std::abs(1.0 * found[i] - expected[i]));
    }
    return most;
  }

  void ExpectTheWhole(PhotonScene& scene, const BlockPartition& partition, const std::vector<Photon>& photons)
  {
    SCOPED_TRACE(std::to_string(partition.blocks.size()) + " ranks");
    const Found expected = this->OnOne(scene, photons), found = this->OnRanks(scene, partition, photons);
    if (!this->GetDevice().IsCpu() && expected.loss.givenUp + found.loss.givenUp > 0)
    {
      GTEST_SKIP() << "on a GPU so many add at once that some give up, as published";
    }
    ASSERT_EQ(expected.loss.givenUp, 0u); // else nothing is to be said of light
    ExpectSameWays(found, expected);
    EXPECT_EQ(found.light.light.fluence, expected.light.light.fluence);
    EXPECT_LT(FurthestOf(found.light.meanDirection, expected.light.meanDirection), 0.005);
    ExpectSamePowers(found.loss.kept, expected.loss.kept, "kept");
    EXPECT_LT(found.loss.Relative(), 1e-6);
  }
};

TEST_F(PublishedPhotonBlocks, HaveTheLightOfTheWholeWhereThePackingLosesNothing)
{
  PhotonScene scene = SmallScene();
  const std::vector<Photon> photons = WholePhotons(scene, 500);
  for (const int ranks : { 2, 5 })
  {
    this->ExpectTheWhole(scene, BlockPartition::Even(scene.medium.grid, ranks), photons);
  }
}

/// Blocks of all shapes, one empty and one a voxel; and as many as there are voxels.
TEST_F(PublishedPhotonBlocks, HaveItWhereRaysBend)
{
  PhotonScene scene = SmallScene();
  scene.SetBall(0.6, 1.5, 1.0);
  const std::vector<Photon> photons = WholePhotons(scene, 500);
  this->ExpectTheWhole(scene, BlockPartition::Even(scene.medium.grid, 3), photons);
  this->ExpectTheWhole(scene, UnevenBlocks(scene), photons);

  PhotonScene tiny({ 3, 2, 2 }, 0.5, 0.5, 0.0f, 0.0f);
  tiny.SetBall(0.5, 1.5, 1.0);
  this->ExpectTheWhole(tiny, BlockPartition::Even(tiny.medium.grid, 13), WholePhotons(tiny, 50));
}

/// A step crosses a node, and several blocks with it.
TEST_F(PublishedPhotonBlocks, HaveItByTheStepsOfAnOctree)
{
  PhotonScene scene = SceneOfNodes(false);
  EXPECT_GE(*std::max_element(scene.levels.begin(), scene.levels.end()), 3) << "no node as large as a block";
  const std::vector<Photon> photons = WholePhotons(scene, 1000);
  for (const int ranks : { 2, 20 })
  {
    this->ExpectTheWhole(scene, BlockPartition::Even(scene.medium.grid, ranks), photons);
  }
}

/// None is lost or taken twice.
TEST_F(PublishedPhotonBlocks, ShareWhatRunsAlongTheirFaces)
{
  PhotonScene scene({ 8, 8, 8 }, 1.0, 4.0, 0.0f, 0.0f);
  for (const int ranks : { 8, 64 })
  {
    this->ExpectTheWhole(scene, BlockPartition::Even(scene.medium.grid, ranks), PhotonsAlongFaces());
  }
}

/// Powers are those of one rank, and light is but for what the packing loses.
TEST_F(PublishedPhotonBlocks, CountWhatOneRankCounts)
{
  PhotonScene scene = SmallScene(3);
  scene.SetBall(0.6, 1.4, 1.0);
  std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 1000);
  for (std::size_t i = 0; i < photons.size(); ++i)
  {
    photons[i].power[i % 3] *= 3.0f;
  }
  photons[7].position = { -50.0, 0.0, 0.0 }; // misses the volume
  photons[7].direction = { 0.0f, 1.0f, 0.0f };
  const Found expected = this->OnOne(scene, photons);
  const Found found = this->OnRanks(scene, UnevenBlocks(scene), photons);
  EXPECT_EQ(found.light.missed, 1u);
  ExpectSameWays(found, expected);
  EXPECT_NEAR(found.loss.Relative(), expected.loss.Relative(), 0.003);
  EXPECT_LT(DifferenceOf(found.light.light.fluence, expected.light.light.fluence), 0.005);
  EXPECT_LT(DifferenceOf(found.light.light.balance.absorbed, expected.light.light.balance.absorbed), 0.005);
  EXPECT_LT(DifferenceOf(found.light.scattered, expected.light.scattered), 0.005);
}

/// Each photon is handed on where it crosses into another block, and costs its 116 bytes.
TEST_F(PublishedPhotonBlocks, HandOnWhatCrosses)
{
  PhotonScene scene({ 12, 4, 4 }, 1.0, 0.0, 0.0f, 0.0f);
  std::vector<Photon> photons;
  for (int i = 0; i < 100; ++i)
  {
    photons.push_back(PhotonFrom({ 0.0, 0.04 * i + 0.01, 1.7 }, { 1.0f, 0.0f, 0.0f }));
  }
  std::vector<RoundsTraffic> traffic;
  this->OnRanks(
    scene, { scene.medium.grid, { { { 0, 0, 0 }, { 3, 4, 4 } }, { { 3, 0, 0 }, { 9, 4, 4 } } } }, photons, &traffic);
  EXPECT_EQ(traffic[0].handed, 100u);
  EXPECT_EQ(traffic[0].bytes, 11600u);
  EXPECT_EQ(traffic[1].handed, 0u);
  EXPECT_EQ(traffic[0].rounds, 2);
}

/// Whatever goes wrong on one rank is one error on each, and none waits for the others.
TEST_F(PublishedPhotonBlocks, FailTogether)
{
  PhotonScene scene = SmallScene();
  const BlockPartition partition = BlockPartition::Even(scene.medium.grid, 3);
  const auto expect = [&](const std::string& words, auto change) {
    const auto march = [&](Communicator& communicator) {
      BlockOfScene part(scene, partition.blocks[communicator.Rank()]);
      PublishedSettings settings;
      std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 100);
      Monitor monitor;
      change(communicator.Rank(), part, settings, photons, monitor);
      MarchPublishedInBlocks(GetDevice(), communicator, partition, part.medium, part.Index(), part.Levels(), photons,
        settings, nullptr, monitor);
    };
    for (const std::string& error : ErrorsOfRanks(3, march))
    {
      EXPECT_NE(error.find(words), std::string::npos) << '"' << error << "\" is not about " << words;
    }
  };
  expect("On rank 1: ",
    [](int rank, BlockOfScene& part, auto&, auto&, auto&) { part.sigma_a[0] = rank == 1 ? -1.0f : 0.1f; });
  expect("Photon 7", [](int rank, auto&, auto&, std::vector<Photon>& photons, auto&) {
    photons[7].power[0] = rank == 0 ? -1.0f : 1.0f;
  });
  expect("disagree about settings", [](int rank, auto&, auto& settings, auto&, auto&) { settings.smooth = rank == 0; });
  expect("has no octree levels", [](int rank, BlockOfScene& part, auto&, auto&, auto&) {
    part.levels.assign(rank == 1 ? 0 : part.medium.grid.VoxelCount(), 0);
  });
  expect("refractive index", [](int rank, BlockOfScene& part, auto&, auto&, auto&) {
    part.ior.assign(rank == 1 ? 0 : part.medium.grid.VoxelCount(), 1.2f);
  });
  expect("components of sigma_a", [](int rank, BlockOfScene& part, auto&, auto&, auto&) {
    part.sigma_s.resize(part.medium.grid.VoxelCount() * 3, 0.1f);
    part.medium.sigma_s = { part.sigma_s.data(), rank == 1 ? 3 : 1 };
  });
  expect("aborted", [](int rank, auto&, auto&, auto&, Monitor& monitor) {
    monitor = [rank](double done) { return rank != 1 || done < 0.6; };
  });
}
