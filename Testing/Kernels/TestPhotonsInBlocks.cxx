// Photons through a medium that is spread over ranks, against those through the whole on one.

#include "BlocksOfScene.h"
#include "DeviceTest.h"
#include "PhotonWays.h"

#include "Distribution/RanksInThreads.h"
#include "Photons/Distributed/PhotonsInBlocks.h"
#include "Photons/Marching/MarchShared.h"

#include <functional>
#include <limits>
#include <mutex>
#include <random>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
void ExpectLightOfTheWhole(const PhotonLight& found, const PhotonLight& expected)
{
  ExpectSameLight(found, expected);
  EXPECT_EQ(found.photonCount, expected.photonCount);
  EXPECT_EQ(found.photonWeight, expected.photonWeight);
  EXPECT_EQ(found.batchFluence, expected.batchFluence);
  EXPECT_EQ(found.missed, expected.missed);
  EXPECT_LT(found.light.balance.RelativeError(found.light.channels), 1e-6);
}

void ExpectSameOnRanks(
  Device& device, PhotonScene& scene, const std::vector<Photon>& photons, const std::vector<int>& ranks)
{
  const PhotonLight expected = scene.March(device, photons);
  for (const int number : ranks)
  {
    SCOPED_TRACE(std::to_string(number) + " ranks");
    ExpectLightOfTheWhole(
      LightOfAll(device, scene, BlockPartition::Even(scene.medium.grid, number), photons), expected);
  }
}
}

class PhotonBlocks : public DeviceTest
{
protected:
  /// Those of all ranks, which are to be rank 0's.
  std::vector<PhotonPath> PathsOfAll(
    const PhotonScene& scene, const BlockPartition& partition, const std::vector<Photon>& photons, std::size_t count)
  {
    const int ranks = static_cast<int>(partition.blocks.size());
    std::vector<std::vector<PhotonPath>> found(ranks);
    RunInThreads(ranks, [&](Communicator& communicator) {
      const int rank = communicator.Rank();
      const BlockOfScene part(scene, partition.blocks[rank]);
      PhotonMarcherInBlocks marcher(
        GetDevice(), communicator, partition, part.medium, part.Index(), scene.settings, part.Levels());
      found[rank] = marcher.Paths(ShareOf(photons, rank, ranks), count);
    });
    for (int rank = 1; rank < ranks; ++rank)
    {
      EXPECT_TRUE(found[rank].empty());
    }
    return found[0];
  }

  void ExpectSamePaths(
    PhotonScene& scene, const BlockPartition& partition, const std::vector<Photon>& photons, std::size_t count)
  {
    const std::vector<PhotonPath> expected =
      scene.Marcher(GetDevice()).Paths(photons, ChooseEvenly(photons.size(), count));
    const std::vector<PhotonPath> found = this->PathsOfAll(scene, partition, photons, count);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      EXPECT_EQ(found[i].photon, expected[i].photon);
      EXPECT_EQ(found[i].points, expected[i].points) << "of photon " << found[i].photon;
      EXPECT_EQ(found[i].left, expected[i].left) << "of photon " << found[i].photon;
    }
  }
};

TEST_F(PhotonBlocks, HaveTheLightOfTheWholeBitForBit)
{
  PhotonScene scene = SmallScene();
  ExpectSameOnRanks(GetDevice(), scene, AnyPhotons(scene.medium.grid, 20000), { 1, 3, 8 });
}

TEST_F(PhotonBlocks, HaveItWhereRaysBend)
{
  PhotonScene scene = SmallScene();
  scene.SetBall(0.6, 1.5, 1.0);
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 1000);
  for (const int order : { 1, 2, 4 })
  {
    for (const double step : { 0.3, 1.0, 3.0 })
    {
      SCOPED_TRACE("order " + std::to_string(order) + ", steps of " + std::to_string(step));
      scene.settings.order = order;
      scene.settings.stepSize = step;
      ExpectSameOnRanks(GetDevice(), scene, photons, { 2, 5, 8 });
    }
  }
}

TEST_F(PhotonBlocks, HaveItWhereEveryVoxelHasAnIndexOfItsOwn)
{
  PhotonScene scene = SmallScene();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(1.0, 1.6);
  scene.SetIndex([&](double, double, double) { return uniform(random); });
  ExpectSameOnRanks(GetDevice(), scene, AnyPhotons(scene.medium.grid, 1000), { 1, 3, 8 });
}

/// A jump makes photons many times as fast as their steps were meant for, and the integrator looks far ahead.
TEST_F(PhotonBlocks, HaveItWhereTheIndexJumps)
{
  PhotonScene scene({ 24, 9, 7 }, 0.2, 0.9, 0.0f, 0.0f);
  Randomise(scene, 1);
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 1000);
  for (const double most : { 4.0, 20.0 })
  {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    scene.SetIndex([&](double, double, double) {
      return most < 20.0 ? (uniform(random) < 0.5 ? 1.0 : most) : 0.05 * std::pow(400.0, uniform(random));
    });
    for (const int order : { 1, 2, 4 })
    {
      for (const double step : { 1.0, 2.0 })
      {
        SCOPED_TRACE("order " + std::to_string(order) + ", steps of " + std::to_string(step));
        scene.settings.order = order;
        scene.settings.stepSize = step;
        ExpectSameOnRanks(GetDevice(), scene, photons, { 8 });
      }
    }
  }
}

TEST_F(PhotonBlocks, HaveItInColourAndCountAndByEitherKindOfSums)
{
  PhotonScene scene = SmallScene(3);
  scene.SetBall(0.6, 1.4, 1.0);
  scene.settings.counts = true;
  std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 1000);
  for (std::size_t i = 0; i < photons.size(); ++i)
  {
    photons[i].power[i % 3] *= 3.0f;
  }
  for (const MarchSettings::Sums sums : { MarchSettings::Sums::Private, MarchSettings::Sums::Shared })
  {
    scene.settings.sums = sums;
    ExpectSameOnRanks(GetDevice(), scene, photons, { 2, 5 });
  }
}

/// One channel stands for three in the whole and on a rank whose own voxels could say otherwise.
TEST_F(PhotonBlocks, AgreeOnColour)
{
  PhotonScene scene = SmallScene();
  std::vector<Photon> orange = AnyPhotons(scene.medium.grid, 500);
  for (Photon& photon : orange)
  {
    photon.power = { 2.0f * photon.power[0], photon.power[0], 0.5f * photon.power[0] };
  }
  ExpectSameOnRanks(GetDevice(), scene, orange, { 3 });

  PhotonScene corner({ 6, 5, 4 }, 0.2, 0.5, 0.0f, 0.0f);
  corner.sigma_a.assign(3 * corner.medium.grid.VoxelCount(), 0.4f);
  corner.sigma_a[0] = 2.0f; // the red of one voxel
  corner.sigma_s.assign(corner.medium.grid.VoxelCount(), 0.0f);
  ExpectSameOnRanks(GetDevice(), corner, AnyPhotons(corner.medium.grid, 500), { 4 });
}

TEST_F(PhotonBlocks, MayBeUnevenEmptyOrOneVoxel)
{
  PhotonScene scene = SmallScene();
  scene.SetBall(0.6, 1.5, 1.0);
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 1000);
  const PhotonLight expected = scene.March(GetDevice(), photons);
  ExpectLightOfTheWhole(LightOfAll(GetDevice(), scene, UnevenBlocks(scene), photons), expected);

  PhotonScene tiny({ 3, 2, 2 }, 0.5, 0.5, 0.3f, 0.2f);
  tiny.SetBall(0.5, 1.5, 1.0);
  ExpectSameOnRanks(GetDevice(), tiny, AnyPhotons(tiny.medium.grid, 500), { 12, 13 });
}

/// Along faces, edges and corners of blocks: none is lost or taken twice.
TEST_F(PhotonBlocks, ShareWhatRunsAlongTheirFaces)
{
  PhotonScene scene({ 8, 8, 8 }, 1.0, 4.0, 0.05f, 0.02f);
  const std::vector<Photon> photons = PhotonsAlongFaces();
  ExpectSameOnRanks(GetDevice(), scene, photons, { 8, 64 });
  scene.SetIndex([](double x, double y, double z) { return 1.4 - 0.02 * (x * x + y * y + z * z) / 16.0; });
  ExpectSameOnRanks(GetDevice(), scene, photons, { 3, 8 });
}

TEST_F(PhotonBlocks, GiveUpWhatGoesRoundForEverAsTheWholeDoes)
{
  PhotonScene scene(16, 2.0);
  scene.SetIndex([](double x, double y, double z) { return fisheye::Index(x, y, z); });
  std::vector<Photon> photons;
  for (const double radius : { 0.6, 0.8, 1.0, 1.2 })
  {
    photons.push_back(PhotonFrom({ radius, 0.1, 0.0 }, { 0.0f, 1.0f, 0.0f }));
  }
  const PhotonLight expected = scene.March(GetDevice(), photons);
  EXPECT_GT(expected.light.balance.leftOver[0], 0.0);
  std::vector<RoundsTraffic> traffic;
  ExpectLightOfTheWhole(
    LightOfAll(GetDevice(), scene, BlockPartition::Even(scene.medium.grid, 4), photons, &traffic), expected);
  EXPECT_GT(traffic[0].rounds, 50);
}

/// Each photon is handed on where it crosses into another block, and costs its 128 bytes.
TEST_F(PhotonBlocks, HandOnWhatCrosses)
{
  PhotonScene scene({ 12, 4, 4 }, 1.0, 6.0, 0.01f, 0.0f);
  scene.medium.grid.origin = { 0.0, 0.0, 0.0 };
  std::vector<Photon> photons;
  for (int i = 0; i < 100; ++i)
  {
    photons.push_back(PhotonFrom({ 0.0, 0.04 * i + 0.01, 1.7 }, { 1.0f, 0.0f, 0.0f }));
  }
  BlockPartition slabs = { scene.medium.grid, {} };
  for (int x = 0; x < 12; x += 3)
  {
    slabs.blocks.push_back({ { x, 0, 0 }, { 3, 4, 4 } });
  }
  std::vector<RoundsTraffic> traffic;
  ExpectLightOfTheWhole(LightOfAll(GetDevice(), scene, slabs, photons, &traffic), scene.March(GetDevice(), photons));
  EXPECT_EQ(sizeof(PhotonOnItsWay), 128u);
  for (int rank = 0; rank < 4; ++rank)
  {
    EXPECT_EQ(traffic[rank].handed, rank < 3 ? 100u : 0u) << rank;
    EXPECT_EQ(traffic[rank].bytes, rank < 3 ? 12800u : 0u) << rank;
    EXPECT_EQ(traffic[rank].rounds, 4) << rank;
  }
}

/// As many as the paths cross from block to block.
TEST_F(PhotonBlocks, HandOnAsOftenAsPathsCross)
{
  PhotonScene scene = SmallScene();
  scene.SetBall(0.6, 1.5, 1.0);
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 300);
  const BlockPartition partition = BlockPartition::Even(scene.medium.grid, 8);
  std::vector<int> blockOf(scene.medium.grid.VoxelCount());
  for (int rank = 0; rank < 8; ++rank)
  {
    for (const std::size_t place : BlockOfScene(scene, partition.blocks[rank]).places)
    {
      blockOf[place] = rank;
    }
  }
  PhotonMarcher marcher = scene.Marcher(GetDevice());
  double crossings = 0.0;
  for (const PhotonPath& path : AllPaths(marcher, photons))
  {
    const std::vector<std::size_t> voxels = VoxelsCrossed(path, scene.medium.grid);
    for (std::size_t i = 1; i < voxels.size(); ++i)
    {
      crossings += blockOf[voxels[i]] != blockOf[voxels[i - 1]] ? 1.0 : 0.0;
    }
  }
  std::vector<RoundsTraffic> traffic;
  LightOfAll(GetDevice(), scene, partition, photons, &traffic);
  double handed = 0.0;
  for (const RoundsTraffic& ofRank : traffic)
  {
    handed += static_cast<double>(ofRank.handed);
  }
  EXPECT_NEAR(handed, crossings, 0.005 * crossings); // paths are cut at walls to float's precision
}

TEST_F(PhotonBlocks, KeepTheLightOfEachBatchApart)
{
  PhotonScene scene = SmallScene();
  scene.SetBall(0.6, 1.5, 1.0);
  scene.settings.batches = true;
  std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 1000);
  for (std::size_t i = 0; i < photons.size(); ++i)
  {
    photons[i].batch = static_cast<std::int32_t>(i * i % 5);
  }
  for (const MarchSettings::Sums sums : { MarchSettings::Sums::Private, MarchSettings::Sums::Shared })
  {
    scene.settings.sums = sums;
    ExpectSameOnRanks(GetDevice(), scene, photons, { 1, 2, 5 });
  }
  EXPECT_EQ(scene.March(GetDevice(), photons).batchFluence.size(), 5 * scene.medium.grid.VoxelCount());
}

/// Corner by corner, whoever marched them where.
TEST_F(PhotonBlocks, HaveThePathsOfTheWhole)
{
  PhotonScene scene = SmallScene();
  std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 300);
  photons[7].position = { -50.0, 0.0, 0.0 }; // misses the volume
  photons[7].direction = { 0.0f, 1.0f, 0.0f };
  for (const bool bends : { false, true })
  {
    if (bends)
    {
      scene.SetBall(0.6, 1.5, 1.0);
    }
    for (const int ranks : { 1, 3, 8, 20 })
    {
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      this->ExpectSamePaths(scene, BlockPartition::Even(scene.medium.grid, ranks), photons, 100);
    }
  }
  this->ExpectSamePaths(scene, BlockPartition::Even(scene.medium.grid, 2), photons, 300);
  this->ExpectSamePaths(scene, BlockPartition::Even(scene.medium.grid, 2), photons, 0);
}

/// A path that is given up has no corner there.
TEST_F(PhotonBlocks, HaveThePathsOfWhatGoesRoundForEver)
{
  PhotonScene scene(16, 2.0);
  scene.SetIndex([](double x, double y, double z) { return fisheye::Index(x, y, z); });
  const std::vector<Photon> photons = { PhotonFrom({ 0.8, 0.1, 0.0 }, { 0.0f, 1.0f, 0.0f }) };
  this->ExpectSamePaths(scene, BlockPartition::Even(scene.medium.grid, 4), photons, 1);
}

TEST_F(PhotonBlocks, AreDarkWithoutPhotons)
{
  PhotonScene scene = SmallScene();
  ExpectSameOnRanks(GetDevice(), scene, {}, { 3 });
}

/// Steps look into nodes that lie in other blocks.
TEST_F(PhotonBlocks, HaveItByTheStepsOfAnOctree)
{
  for (const bool glass : { false, true })
  {
    PhotonScene scene = SceneOfNodes(glass);
    const int largest = *std::max_element(scene.levels.begin(), scene.levels.end());
    EXPECT_GE(largest, 3) << "no node as large as a block";
    const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 2000);
    for (const int order : { 1, 4, 2 })
    {
      SCOPED_TRACE("order " + std::to_string(order) + (glass ? ", glass" : ", waves"));
      scene.settings.order = order;
      ExpectSameOnRanks(GetDevice(), scene, photons, { 1, 3, 8 });
    }
    scene.settings.leaveOut = false;
    ExpectSameOnRanks(GetDevice(), scene, photons, { 5 });
  }
}

/// Steps of order 4 look at the index ahead, as far as cubes of 2^YoshidaLevel voxels reach, in which they cross larger
/// nodes. Blocks are thinner than that, and no rank knows the index of the whole.
TEST_F(PhotonBlocks, HaveItByLongStepsOfOrderFour)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const bool jumps : { false, true })
  {
    SCOPED_TRACE(jumps ? "waves and jumps" : "waves");
    PhotonScene scene({ 75, 11, 10 }, 0.1, 0.5, 0.0f, 0.0f);
    Randomise(scene, 1);
    scene.SetIndex([&](double x, double y, double z) {
      const double waves = 1.2 + 0.008 * std::sin(1.5 * x + 1.0) * std::cos(2.0 * y) * std::cos(z + 0.5);
      const bool jump = jumps && x > 2.7 && x < 3.5; // between nodes of 32 and of 64 voxels
      return jump ? 0.05 * std::pow(400.0, uniform(random)) : waves;
    });
    SetOctree(scene, 0.02);
    EXPECT_GT(*std::max_element(scene.levels.begin(), scene.levels.end()), YoshidaLevel + 1);
    scene.settings.order = 4;
    std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 1000);
    for (std::size_t i = 0; i < photons.size(); i += 2)
    {
      photons[i].direction = { i % 4 > 0 ? 0.995f : -0.995f, 0.06f, -0.08f }; // along the blocks
    }
    ExpectSameOnRanks(GetDevice(), scene, photons, { 1, 2, 5 });
    ExpectSamePaths(scene, BlockPartition::Even(scene.medium.grid, 5), photons, 60);
  }
}

TEST_F(PhotonBlocks, HaveItByAnOctreeInUnevenBlocks)
{
  PhotonScene scene = SmallScene();
  scene.SetBall(0.7, 1.4, 1.0);
  SetOctree(scene, 0.2);
  const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 1000);
  const PhotonLight expected = scene.March(GetDevice(), photons);
  ExpectLightOfTheWhole(LightOfAll(GetDevice(), scene, UnevenBlocks(scene), photons), expected);
  ExpectSamePaths(scene, UnevenBlocks(scene), photons, 60);
}

/// Whatever goes wrong on one rank is one error on each, and none waits for the others.
class PhotonBlocksFail : public PhotonBlocks
{
protected:
  struct Given
  {
    BlockOfScene& part;
    BlockPartition& partition;
    MarchSettings& settings;
    std::vector<Photon>& photons;
    Monitor& monitor;
  };
  using Change = std::function<void(int rank, Given given)>;

  void ExpectErrors(const std::string& words, const Change& change)
  {
    PhotonScene scene = SmallScene();
    scene.SetBall(0.6, 1.5, 1.0);
    const BlockPartition partition = BlockPartition::Even(scene.medium.grid, 3);
    const std::vector<std::string> errors = ErrorsOfRanks(3, [&](Communicator& communicator) {
      const int rank = communicator.Rank();
      BlockOfScene part(scene, partition.blocks[rank]);
      BlockPartition given = partition;
      MarchSettings settings = scene.settings;
      std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 100);
      Monitor monitor;
      change(rank, { part, given, settings, photons, monitor });
      PhotonMarcherInBlocks(GetDevice(), communicator, given, part.medium, part.Index(), settings, part.Levels())
        .March(photons, monitor);
    });
    for (const std::string& error : errors)
    {
      EXPECT_NE(error.find(words), std::string::npos) << '"' << error << "\" is not about " << words;
    }
  }
};

TEST_F(PhotonBlocksFail, TogetherWhereOneHasBadInput)
{
  ExpectErrors("On rank 1: ", [](int rank, Given given) { given.part.sigma_a[0] = rank == 1 ? -1.0f : 0.1f; });
  ExpectErrors("On rank 2: ", [](int rank, Given given) { given.part.ior[0] = rank == 2 ? 0.0f : 1.0f; });
  ExpectErrors("Photon 7", [](int rank, Given given) {
    given.photons[7].power[0] = rank == 0 ? std::numeric_limits<float>::quiet_NaN() : 1.0f;
  });
  ExpectErrors("does not have the size", [](int rank, Given given) {
    if (rank == 1)
    {
      --given.part.medium.grid.size[2];
    }
  });
  ExpectErrors("not a block for each rank", [](int, Given given) {
    given.partition = BlockPartition::Even(given.partition.whole, 2);
    given.part.medium.grid.size = given.partition.blocks[0].size;
  });
}

TEST_F(PhotonBlocksFail, TogetherWhereTheyDisagree)
{
  ExpectErrors("disagree about settings", [](int rank, Given given) { given.settings.stepSize = 1.0 + rank; });
  ExpectErrors("disagree about settings", [](int rank, Given given) { given.settings.seed = 1 + rank; });
  ExpectErrors("has no octree levels",
    [](int rank, Given given) { given.part.levels.assign(rank == 1 ? 0 : given.part.medium.grid.VoxelCount(), 0); });
  ExpectErrors("disagree about the grid", [](int rank, Given given) { given.partition.whole.origin[0] += rank; });
}

TEST_F(PhotonBlocksFail, TogetherWhereOneIsStopped)
{
  ExpectErrors("aborted", [](int rank, Given given) {
    if (rank == 1)
    {
      given.monitor = [](double done) { return done < 0.6; };
    }
  });
}

TEST_F(PhotonBlocksFail, WithWordsOnWhatIsNotCarriedFromRankToRank)
{
  ExpectErrors("Unsafe", [](int, Given given) { given.settings.sums = MarchSettings::Sums::Unsafe; });
  EXPECT_EQ(NotInBlocks({}), "");
}
