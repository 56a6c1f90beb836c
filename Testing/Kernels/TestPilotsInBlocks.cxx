// Pilot photons through a medium that is spread over ranks, against those through the whole on one.
#include "BlocksOfScene.h"
#include "DeviceTest.h"
#include "PhotonWays.h"

#include "Distribution/RanksInThreads.h"
#include "Photons/Distributed/PhotonsInBlocks.h"
#include "Photons/Importance/PhotonImportance.h"

#include <algorithm>
#include <random>
#include <string>

using namespace tyndall;

namespace
{
std::vector<std::array<int, 2>> AnyOrigins(std::size_t count)
{
  std::mt19937 random(5);
  std::uniform_int_distribution<int> place(0, 63);
  std::vector<std::array<int, 2>> origins(count);
  for (std::array<int, 2>& origin : origins)
  {
    origin = { place(random), place(random) };
  }
  return origins;
}
}

class PilotBlocksTest : public DeviceTest
{
protected:
  void ExpectTheWhole(PhotonScene& scene, const BlockPartition& partition, const std::array<int, 3>& cells)
  {
    const std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 3000);
    const std::vector<std::array<int, 2>> origins = AnyOrigins(photons.size());
    const PilotLight expected = scene.Marcher(GetDevice()).Gather(photons, origins, cells);
    RunInThreads(static_cast<int>(partition.blocks.size()), [&](Communicator& communicator) {
      const BlockOfScene part(scene, partition.blocks[static_cast<std::size_t>(communicator.Rank())]);
      PhotonMarcherInBlocks marcher(GetDevice(), communicator, partition, part.medium, part.Index(), scene.settings);
      const PilotLight found = marcher.Gather(photons, origins, cells);
      EXPECT_EQ(found.grid.size, expected.grid.size);
      EXPECT_EQ(found.fluence, expected.fluence);
      EXPECT_EQ(found.count, expected.count) << "on rank " << communicator.Rank() << " of " << communicator.Ranks();
      EXPECT_EQ(found.originMean, expected.originMean);
      EXPECT_EQ(found.originDeviation, expected.originDeviation);
    });
  }
};

/// Cells lie in several blocks, and count a photon once all the same.
TEST_F(PilotBlocksTest, GatherTheLightOfTheWholeBitForBit)
{
  PhotonScene scene = SmallScene();
  scene.SetBall(0.6, 1.5, 1.0);
  for (const int ranks : { 1, 3, 8 })
  {
    this->ExpectTheWhole(scene, BlockPartition::Even(scene.medium.grid, ranks), { 5, 4, 3 });
  }
  this->ExpectTheWhole(scene, UnevenBlocks(scene), { 1, 2, 100 });
}

TEST_F(PilotBlocksTest, GatherColours)
{
  PhotonScene scene = SmallScene(3);
  this->ExpectTheWhole(scene, BlockPartition::Even(scene.medium.grid, 3), { 4, 4, 4 });
}

TEST_F(PilotBlocksTest, FindTheMapOfTheWhole)
{
  PhotonScene scene = SceneOfNodes(true);
  scene.levels.clear();
  Illumination light;
  Light sun;
  sun.direction = { 0.2, 0.3, 1.0 };
  light.lights = { sun };
  ImportanceSettings settings;
  settings.pilotCount = 1024;
  settings.cells = { 8, 8, 8 };
  PhotonMarcher whole = scene.Marcher(GetDevice());
  const std::vector<float> gradient = FindImportance(whole, scene.medium.grid, light, settings).gradient;
  settings.automatic = false;
  settings.gradientThreshold = 0.5 * *std::max_element(gradient.begin(), gradient.end());
  const Importance expected = FindImportance(whole, scene.medium.grid, light, settings);
  EXPECT_FALSE(expected.even);
  const BlockPartition partition = BlockPartition::Even(scene.medium.grid, 3);
  RunInThreads(3, [&](Communicator& communicator) {
    const BlockOfScene part(scene, partition.blocks[static_cast<std::size_t>(communicator.Rank())]);
    PhotonMarcherInBlocks marcher(GetDevice(), communicator, partition, part.medium, part.Index(), scene.settings);
    const Gatherer gather = [&](const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins,
                              const std::array<int, 3>& cells,
                              const Monitor& monitor) { return marcher.Gather(photons, origins, cells, monitor); };
    const Importance found = FindImportance(gather, scene.medium.grid, light, settings);
    EXPECT_EQ(found.map.density, expected.map.density);
    EXPECT_EQ(found.chosen, expected.chosen);
    EXPECT_EQ(found.even, expected.even);
  });
}

TEST_F(PilotBlocksTest, FailTogether)
{
  PhotonScene scene = SmallScene();
  const BlockPartition partition = BlockPartition::Even(scene.medium.grid, 3);
  RunInThreads(3, [&](Communicator& communicator) {
    const BlockOfScene part(scene, partition.blocks[static_cast<std::size_t>(communicator.Rank())]);
    PhotonMarcherInBlocks marcher(GetDevice(), communicator, partition, part.medium, part.Index(), scene.settings);
    try
    {
      marcher.Gather(AnyPhotons(scene.medium.grid, 10), AnyOrigins(communicator.Rank() == 1 ? 9 : 10), { 2, 2, 2 });
      ADD_FAILURE() << "taken on rank " << communicator.Rank();
    }
    catch (const InvalidInput& error)
    {
      EXPECT_NE(std::string(error.what()).find("9 origins"), std::string::npos) << error.what();
    }
  });
}
