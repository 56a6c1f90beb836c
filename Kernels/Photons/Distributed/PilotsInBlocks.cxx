#include "Photons/Distributed/PilotsInBlocks.h"

#include "Device/Clock.h"
#include "Distribution/Rounds.h"
#include "Photons/Distributed/BlockMarch.h"
#include "Photons/Distributed/PhotonShares.h"
#include "Photons/Importance/PilotGathering.h"

#include <cmath>
#include <memory>
#include <utility>

namespace tyndall
{
namespace
{
/// What one rank's photons leave, on their ways through its block.
struct PilotMarch
{
  PilotMarch(const MarchMedium& medium, const PackedPhotons& packed, const std::array<int, 3>& cells)
    : cellOfVoxel(medium.Cells(cells))
    , sums(medium, packed, this->cellOfVoxel, Grid{ cells }.VoxelCount())
    , march(medium, this->sums.Target(), packed)
  {
  }

  const Buffer<cl_int> cellOfVoxel;
  const PilotSums sums;
  BlockMarch march;
};
}

PilotLight GatherInBlocks(const PilotBlocks& blocks, const std::vector<Photon>& photons,
  const std::vector<std::array<int, 2>>& origins, const std::array<int, 3>& cells, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const Grid& whole = blocks.partition.whole;
  Communicator& communicator = blocks.communicator;
  PackedPhotons all, own;
  PilotLight light;
  std::unique_ptr<PilotMarch> pilots;
  communicator.Collective([&] {
    CheckOrigins(photons, origins);
    all = Pack(photons, whole, blocks.traits.Channels(blocks.settings) == 3, MarchEventLimit(whole, blocks.settings));
    light = DarkPilotLight(whole, cells, blocks.traits.ColoursOf(all));
    if (blocks.through)
    {
      const auto rank = static_cast<std::size_t>(communicator.Rank());
      own = ThoseIn(blocks.partition.blocks[rank], whole, all);
      pilots = std::make_unique<PilotMarch>(*blocks.through, own, light.grid.size);
    }
  });
  Rounds rounds(communicator, blocks.partition);
  rounds.UntilAllEnd<PhotonOnItsWay>(
    [&](int round, std::vector<PhotonOnItsWay>&& arrived, const Monitor& ofRound) {
      if (!pilots)
      {
        return std::vector<PhotonOnItsWay>();
      }
      return round == 0 ? pilots->march.Start(own, MarksOfOrigins(origins, own), ofRound).gone
                        : pilots->march.Resume(std::move(arrived), ofRound).gone;
    },
    monitor);
  std::vector<std::int64_t> sums(light.grid.VoxelCount() * NumbersOfCell(all), 0);
  communicator.Collective([&] { sums = pilots ? pilots->sums.AddUp() : sums; });
  const double diagonal = std::hypot(whole.spacing[0], whole.spacing[1], whole.spacing[2]);
  PutCells(SumExactly(communicator, sums), whole, all, all.unit * diagonal, light);
  light.seconds = ClockSeconds() - start;
  return light;
}
}
