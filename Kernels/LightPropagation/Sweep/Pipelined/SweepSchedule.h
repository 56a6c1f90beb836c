#pragma once

#include "Distribution/BlockPartition.h"
#include "LightPropagation/Sweep/SweepOperator.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Rays that march along one axis and whose directions lie in one octant: they run from one corner of the box towards
/// the opposite one. Blocks of a grid are swept along such a set one after the other, each after the blocks upwind of
/// it.
struct ParallelBundles
{
  int axis = 0;
  int way = 0;                            ///< 0 forward along the axis, 1 backward
  std::array<int, 3> signs = { 1, 1, 1 }; ///< along x, y, z: 1 upwards, -1 downwards
  std::vector<Bundle> bundles;            ///< each member has a direction for one way only
  bool goThroughEdges = false;            ///< some rays move along u and v at once

  int Rays() const; ///< rays per voxel of a plane across the axis
};

/// Divides rays into sets of parallel bundles by octant. @param mostRays  most rays per set; 0: no limit
std::vector<ParallelBundles> SortByOctant(const std::vector<AxisBundles>& rays, int mostRays);

/// Set of faces through which rays pass from one block into another.
struct BlockContact
{
  enum Kind
  {
    Along,  ///< through faces across the marching axis, at the end of a plane
    AsideU, ///< through faces across u or v, within a plane
    AsideV,
    Edge ///< by a move along u and v at once
  };
  int from = 0, to = 0;
  Kind kind = Along;
  VoxelBox cells;      ///< voxels that the rays come from, indexed in the whole grid
  bool around = false; ///< the rays wrap around a periodic axis
};

/// All contacts from one block to another, or to itself around periodic axes: none or one of most kinds, in the order
/// of Kind.
std::vector<BlockContact> ContactsBetween(const BlockPartition& partition, const ParallelBundles& rays, int from,
  int to, const std::array<bool, 3>& periodic = {});

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
