#pragma once

#include "Distribution/BlockPartition.h"
#include "LightPropagation/Sweep/Pipelined/ParallelBundles.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// What the parts of a distributed sweep take, in any unit of time.
struct SweepCosts
{
  double ofRay = 1.0;     ///< a ray through a voxel
  double ofTask = 0.0;    ///< each block and each set of parallel bundles besides
  double ofMessage = 0.0; ///< from one rank to another
  double ofValue = 0.0;   ///< each ray in it
};

/// In which order each rank sweeps its block along the sets of parallel bundles: those of all octants start at once
/// from their corners, and where several could be swept the one goes first behind which most blocks wait. Found by
/// playing the sweep through; the same on all ranks, whatever they then take.
class SweepSchedule
{
public:
  /// @throws InvalidInput where blocks wait for each other: no planes cut them apart one after the other
  SweepSchedule(const BlockPartition& partition, const std::vector<ParallelBundles>& tasks, const SweepCosts& costs);

  /// Tasks in the order of a rank; none of an empty block.
  const std::vector<int>& OrderOf(int rank) const { return this->Orders[rank]; }

  double Time() const { return this->Makespan; }        ///< until the last rank is through
  double BusyTime() const { return this->Work; }        ///< of all ranks together
  std::size_t Messages() const { return this->Sent; }   ///< of all
  std::size_t Values() const { return this->SentRays; } ///< at most: rays in them, of one channel
  /// That light comes through one after the other, at most.
  int BlocksInALine() const { return this->InALine; }

private:
  std::vector<std::vector<int>> Orders;
  int InALine = 0;
  double Makespan = 0.0, Work = 0.0;
  std::size_t Sent = 0, SentRays = 0;
};

/// The rays of a sweep as sets of parallel bundles, of as many rays each as bring it to its end soonest: fewer keep
/// more ranks busy, and cost each of them and the network more often. The same on all ranks.
std::vector<ParallelBundles> FastestParts(const BlockPartition& partition, const std::vector<AxisBundles>& rays);
}
