#pragma once

#include "Distribution/BlockPartition.h"
#include "LightPropagation/Sweep/SweepOperator.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Rays that march along one axis and whose directions are in one octant, so that they cross the domain from one corner
/// to the opposite one. Blocks are swept along such a set one after another, each block after the blocks upwind of it.
struct ParallelBundles
{
  int axis = 0;
  int way = 0;                            ///< sense of marching: 0 forward along the axis, 1 backward
  std::array<int, 3> signs = { 1, 1, 1 }; ///< sign of the directions along x, y, z: 1 or -1
  /// Bundles of these rays; each member (pair of opposite directions) has only the direction that marches in sense
  /// `way`
  std::vector<Bundle> bundles;
  bool goThroughEdges = false; ///< whether any ray moves diagonally, along both transverse axes u and v, in one step

  int Rays() const; ///< number of rays per voxel of a plane across the marching axis
};

/// Divides rays into sets of parallel bundles by octant.
/// @param mostRays  maximum number of rays per set; 0: no limit
std::vector<ParallelBundles> SortByOctant(const std::vector<AxisBundles>& rays, int mostRays);

/// Set of voxel faces through which rays pass from one block into another.
struct BlockContact
{
  enum Kind
  {
    /// Through faces normal to the marching axis, after rays have crossed the last plane of a block
    Along,
    AsideU, ///< AsideU, AsideV: through faces normal to u, v, by rays that move sideways within a plane of voxels
    AsideV,
    Edge ///< through an edge of the block: rays that move diagonally, along both u and v, in one step
  };
  int from = 0, to = 0;
  Kind kind = Along;
  VoxelBox cells;      ///< voxels from which the rays come, indexed in the whole domain
  bool around = false; ///< whether the rays wrap around a periodic axis
};

/// All contacts from block `from` to block `to` (around periodic axes possibly the same block), in the order of Kind.
std::vector<BlockContact> ContactsBetween(const BlockPartition& partition, const ParallelBundles& rays, int from,
  int to, const std::array<bool, 3>& periodic = {});

/// Cost model of a distributed sweep, in an arbitrary unit of time.
struct SweepCosts
{
  double ofRay = 1.0;     ///< cost per ray and voxel
  double ofTask = 0.0;    ///< overhead per block and set of parallel bundles
  double ofMessage = 0.0; ///< cost per message between ranks
  double ofValue = 0.0;   ///< cost per message of each ray in it, counted per voxel face that the ray crosses
};

/// Order in which each rank sweeps its block along the sets of parallel bundles of rays. The sets of all octants start
/// concurrently from their corners; if several sets are ready on a rank, it first sweeps along the set with the longest
/// chain of waiting blocks downwind. The order is computed by simulating the sweep; identical on all ranks, whatever
/// the actual run times.
class SweepSchedule
{
public:
  /// @param tasks  sets of parallel bundles of rays; a task is the sweep of a rank's block along one set
  /// @throws InvalidInput if blocks wait for each other's rays in a cycle, which cannot occur if the partition is made
  /// by successive cuts along planes
  SweepSchedule(const BlockPartition& partition, const std::vector<ParallelBundles>& tasks, const SweepCosts& costs);

  /// Indices of the sets of bundles in the order in which `rank` sweeps along them; empty if its block is empty.
  const std::vector<int>& OrderOf(int rank) const { return this->Orders[rank]; }

  double Time() const { return this->Makespan; }      ///< simulated time until the last rank has finished
  double BusyTime() const { return this->Work; }      ///< simulated time of computation, sum over all ranks
  std::size_t Messages() const { return this->Sent; } ///< number of messages sent by all ranks in one sweep
  /// Upper bound of the number of rays in all messages of one sweep, for one channel
  std::size_t Values() const { return this->SentRays; }
  /// Number of blocks in the longest chain of blocks that light crosses one after another.
  int BlocksInALine() const { return this->InALine; }

private:
  std::vector<std::vector<int>> Orders;
  int InALine = 0;
  double Makespan = 0.0, Work = 0.0;
  std::size_t Sent = 0, SentRays = 0;
};

/// Divides the rays of a sweep into sets of parallel bundles, with the number of rays per set that minimises the
/// simulated time of the sweep: smaller sets keep more ranks busy, but add overhead and messages. Identical on all
/// ranks.
std::vector<ParallelBundles> FastestParts(const BlockPartition& partition, const std::vector<AxisBundles>& rays);
}
