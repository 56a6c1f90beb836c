#pragma once

#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace tyndall
{
/// What ranks handed to each other.
struct RoundsTraffic
{
  std::size_t handed = 0; ///< travellers, by this rank; one counts each time that it goes into another block
  std::size_t bytes = 0;  ///< of them
  int rounds = 0;         ///< of following and handing on, until none was left anywhere
};

/// Photons, or beams of a lamp, go from rank to rank in rounds: each rank follows those that it has as far as its block
/// goes, and hands them on to the ranks whose blocks touch it, or are as near as it may go beyond.
///
/// A type of traveller has a function `const int* WhereIs(const Traveller&)` beside it: the voxel of the whole grid in
/// which it goes on.
class Rounds
{
public:
  /// @param communicator, partition  must stay; as many blocks as ranks
  /// @param reach  voxels beyond its block that a traveller goes before it is handed on, the same on all ranks
  /// @param periodic  axes whose two ends touch
  Rounds(Communicator& communicator, const BlockPartition& partition, int reach = 1,
    const std::array<bool, 3>& periodic = {});

  /// Follows those that have come (in the first round: that set off here), and gives back those that go on elsewhere.
  template <class OnItsWay>
  using Follow =
    std::function<std::vector<OnItsWay>(int round, std::vector<OnItsWay>&& arrived, const Monitor& monitor)>;

  /// Until none is left anywhere. All ranks call it.
  /// @throws  on every rank, what `follow` throws on one of them
  template <class OnItsWay>
  void UntilAllEnd(const Follow<OnItsWay>& follow, const Monitor& monitor)
  {
    std::vector<OnItsWay> arrived;
    int round = 0;
    double done = 0.0;
    for (bool left = true; left; ++round)
    {
      const std::vector<std::vector<OnItsWay>> parcels = this->Comm.Exchange<OnItsWay>(this->Neighbours, [&] {
        const double next = this->Neighbours.empty() ? 1.0 : 0.5 * (1.0 + done); // how far the round goes
        const Monitor ofRound = OfPart(monitor, done, next);
        std::vector<std::vector<OnItsWay>> gone = this->Sorted(follow(round, std::move(arrived), ofRound));
        Report(monitor, done = next);
        return gone;
      });
      arrived.clear();
      for (const std::vector<OnItsWay>& parcel : parcels)
      {
        arrived.insert(arrived.end(), parcel.begin(), parcel.end());
      }
      left = this->Comm.Largest({ arrived.empty() ? 0.0 : 1.0 })[0] > 0.0;
    }
    this->Handed.rounds += round;
  }

  const RoundsTraffic& Traffic() const { return this->Handed; }

private:
  /// By the neighbours whose blocks they go into.
  template <class OnItsWay>
  std::vector<std::vector<OnItsWay>> Sorted(const std::vector<OnItsWay>& gone)
  {
    std::vector<std::vector<OnItsWay>> parcels(this->Neighbours.size());
    for (const OnItsWay& one : gone)
    {
      parcels[this->NeighbourWith(WhereIs(one))].push_back(one);
    }
    this->Handed.handed += gone.size();
    this->Handed.bytes += gone.size() * sizeof(OnItsWay);
    return parcels;
  }

  std::size_t NeighbourWith(const int* voxel) const;

  Communicator& Comm;
  const BlockPartition& Partition;
  std::vector<int> Neighbours; ///< ranks
  RoundsTraffic Handed;
};
}
