#pragma once

#include "Distribution/BlockPartition.h"
#include "LightPropagation/Sweep/Pipelined/ParallelBundles.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// Cost model of a distributed sweep, in any unit of time.
struct SweepCosts
{
  double ofRay = 1.0;     ///< per ray and voxel
  double ofTask = 0.0;    ///< overhead per block and set of parallel bundles
  double ofMessage = 0.0; ///< per message between ranks
  double ofValue = 0.0;   ///< per ray in a message
};

/// Order in which each rank sweeps its block along the sets of parallel bundles. The sets of all octants start
/// concurrently from their corners; if a rank has a choice, it first sweeps the set for which most blocks are waiting
/// downwind. Computed by simulating the sweep; identical on all ranks, whatever the actual run times.
class SweepSchedule
{
public:
  /// @throws InvalidInput if blocks wait for each other in a cycle, i.e. the partition cannot be made by successive
  /// cuts along planes
  SweepSchedule(const BlockPartition& partition, const std::vector<ParallelBundles>& tasks, const SweepCosts& costs);

  /// Tasks in the order in which `rank` runs them; empty if its block is empty.
  const std::vector<int>& OrderOf(int rank) const { return this->Orders[rank]; }

  double Time() const { return this->Makespan; }        ///< until the last rank has finished
  double BusyTime() const { return this->Work; }        ///< sum over all ranks
  std::size_t Messages() const { return this->Sent; }   ///< sent by all ranks
  std::size_t Values() const { return this->SentRays; } ///< upper bound of the rays in all messages, for one channel
  /// Length of the longest chain of blocks that light crosses one after the other.
  int BlocksInALine() const { return this->InALine; }

private:
  std::vector<std::vector<int>> Orders;
  int InALine = 0;
  double Makespan = 0.0, Work = 0.0;
  std::size_t Sent = 0, SentRays = 0;
};

/// Divides the rays of a sweep into sets of parallel bundles, with the number of rays per set that minimises the time
/// of the sweep: smaller sets keep more ranks busy, but add overhead and messages. Identical on all ranks.
std::vector<ParallelBundles> FastestParts(const BlockPartition& partition, const std::vector<AxisBundles>& rays);
}
