// Photons that march in turns through a medium that is spread over ranks, against those through the whole.

#include "BlocksOfScene.h"
#include "DeviceTest.h"
#include "PhotonWays.h"

#include "Photons/Distributed/TurnsInBlocks.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

using namespace tyndall;

class TurnsOfBlocks : public DeviceTest
{
protected:
  using Shown = std::vector<std::vector<float>>; ///< fluence after each turn

  PhotonLight OfWhole(PhotonScene& scene, const std::vector<Photon>& photons, int stretches, Shown& shown)
  {
    MarchTurns turns;
    turns.stretches = stretches;
    turns.begin = [](const PackedPhotons&, int) {};
    turns.meanwhile = [&](const cl::CommandQueue& queue) {
      std::array<cl::Event, 2> events;
      queue.enqueueMarkerWithWaitList(nullptr, &events[0]);
      queue.enqueueMarkerWithWaitList(nullptr, &events[1]);
      return events;
    };
    turns.take = [&](const cl::CommandQueue& queue, const Buffer<float>& fluence) {
      shown.emplace_back(fluence.Size());
      queue.enqueueReadBuffer(fluence.Handle(), CL_TRUE, 0, fluence.Size() * sizeof(float), shown.back().data());
    };
    TurnTimes times;
    return scene.Marcher(this->GetDevice()).MarchByTurns(photons, turns, times);
  }

  PhotonLight OfBlocks(const PhotonScene& scene, const BlockPartition& partition, const std::vector<Photon>& photons,
    int stretches, Shown& shown)
  {
    const int ranks = static_cast<int>(partition.blocks.size());
    PhotonLight all;
    std::mutex guard;
    RunInThreads(ranks, [&](Communicator& communicator) {
      const int rank = communicator.Rank();
      const BlockOfScene part(scene, partition.blocks[rank]);
      PhotonMarcher marcher(
        this->GetDevice(), Domain(communicator, partition), part.medium, part.Index(), scene.settings, part.Levels());
      std::size_t turn = 0, meanwhiles = 0;
      TurnsInBlocks turns;
      turns.stretches = stretches;
      turns.begin = [](const PackedPhotons&, int) {};
      turns.meanwhile = [&] { ++meanwhiles; };
      turns.take = [&](const Buffer<float>& fluence) {
        const std::vector<float> values = fluence.Size() > 0 ? fluence.Read() : std::vector<float>();
        const std::lock_guard<std::mutex> lock(guard);
        shown.resize(std::max(shown.size(), ++turn));
        part.Put(values, shown[turn - 1], partition.whole.VoxelCount());
      };
      const PhotonLight light = marcher.MarchByTurns(ShareOf(photons, rank, ranks), turns);
      const std::lock_guard<std::mutex> lock(guard);
      EXPECT_EQ(meanwhiles, turn - 1);
      PhotonLight arrays = std::exchange(all, light);
      part.Put(light.light.fluence, arrays.light.fluence, partition.whole.VoxelCount());
      all.light.fluence = arrays.light.fluence;
    });
    return all;
  }
};

/// Bit for bit after each turn, wherever photons have come to, and in as many turns.
TEST_F(TurnsOfBlocks, ShowTheLightOfTheWhole)
{
  for (const bool bends : { false, true })
  {
    SCOPED_TRACE(bends);
    PhotonScene scene = SmallScene();
    if (bends)
    {
      scene.SetBall(0.6, 1.5, 1.0);
    }
    std::vector<Photon> photons = AnyPhotons(scene.medium.grid, 1001);
    photons[5].power[1] *= bends ? 0.5f : 1.0f;
    for (const int stretches : bends ? std::vector<int>{ 7 } : std::vector<int>{ 1, 7, 0 })
    {
      Shown expected;
      const PhotonLight whole = this->OfWhole(scene, photons, stretches, expected);
      for (const BlockPartition& partition : { BlockPartition::Even(scene.medium.grid, 3), UnevenBlocks(scene) })
      {
        SCOPED_TRACE(std::to_string(stretches) + ", " + std::to_string(partition.blocks.size()) + " ranks");
        Shown shown;
        const PhotonLight light = this->OfBlocks(scene, partition, photons, stretches, shown);
        EXPECT_EQ(shown, expected);
        EXPECT_EQ(light.light.fluence, whole.light.fluence);
        EXPECT_EQ(light.deposits, whole.deposits);
        EXPECT_EQ(light.steps, whole.steps);
        EXPECT_EQ(light.light.facePowerOut, whole.light.facePowerOut);
      }
    }
  }
}
