#pragma once

#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <vector>

namespace tyndall
{
/// Counts of the travellers (photons, rays or beams) that Rounds has sent between ranks.
struct RoundsTraffic
{
  /// Number of travellers (photons, rays or beams) sent by this rank; a traveller counts each time that it enters
  /// another rank's block.
  std::size_t handed = 0;
  std::size_t bytes = 0; ///< size of the travellers (photons, rays or beams) sent by this rank, bytes
  int rounds = 0;        ///< number of rounds of tracing and exchange, until no photon, ray or beam was left
};

/// Traces travellers (photons, rays, or beams of a lamp) through a distributed grid in rounds. In each round, a rank
/// follows its travellers to the end of its block, then sends them to the neighbouring ranks whose blocks they enter.
///
/// A traveller type needs a free function `const int* WhereIs(const Traveller&)`, which returns the indices of the
/// voxel of the whole grid in which the traveller continues.
class Rounds
{
public:
  /// Determines the neighbouring ranks of this rank.
  /// @param communicator, partition  must outlive this object; one block per rank
  /// @param reach  largest distance, voxels, that a traveller may go beyond its block before it is sent on; the same on
  ///   all ranks
  /// @param periodic  periodic axes, whose ends touch
  Rounds(Communicator& communicator, const BlockPartition& partition, int reach = 1,
    const std::array<bool, 3>& periodic = {})
    : Comm(communicator)
    , Partition(partition)
    , Neighbours(NeighboursOf(partition, communicator.Rank(), reach, periodic))
  {
  }

  /// Function that traces the travellers (photons, rays or beams) that arrived in a round; in the first round, those
  /// that start in this block. Returns the travellers that continue in other blocks.
  template <class OnItsWay>
  using Follow =
    std::function<std::vector<OnItsWay>(int round, std::vector<OnItsWay>&& arrived, const Monitor& monitor)>;

  /// Repeats rounds of tracing and exchange until no traveller (photon, ray or beam) is left on any rank. Collective.
  /// @throws on every rank, the error that `follow` throws on one rank
  template <class OnItsWay>
  void UntilAllEnd(const Follow<OnItsWay>& follow, const Monitor& monitor)
  {
    std::vector<OnItsWay> arrived;
    int round = 0;
    double done = 0.0;
    for (bool left = true; left; ++round)
    {
      const std::vector<std::vector<OnItsWay>> parcels = this->Comm.Exchange<OnItsWay>(this->Neighbours, [&] {
        // Progress to report at the end of this round. The number of rounds is not known in advance, so each round is
        // assumed to do half of the remaining work.
        const double next = this->Neighbours.empty() ? 1.0 : 0.5 * (1.0 + done);
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
  /// Sorts travellers (photons, rays or beams) by the neighbouring rank whose block they enter.
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

  std::size_t NeighbourWith(const int* voxel) const
  {
    const auto holds = [&](int rank) { return Holds(this->Partition.blocks[static_cast<std::size_t>(rank)], voxel); };
    const auto to = std::find_if(this->Neighbours.begin(), this->Neighbours.end(), holds);
    if (to == this->Neighbours.end())
    {
      throw std::logic_error("Light has left a block into one that does not touch it.");
    }
    return static_cast<std::size_t>(to - this->Neighbours.begin());
  }

  Communicator& Comm;
  const BlockPartition& Partition;
  std::vector<int> Neighbours; ///< ranks of neighbouring blocks
  RoundsTraffic Handed;
};
}
