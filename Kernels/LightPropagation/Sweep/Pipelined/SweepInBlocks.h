#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LightPropagation/Sweep/Pipelined/BlockSweep.h"
#include "LightPropagation/Sweep/Pipelined/SweepSchedule.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <exception>
#include <memory>
#include <vector>

namespace tyndall
{
/// Adds the power that left through each cell of the domain's faces on any rank, W, to an array of which every rank has
/// a copy. Collective.
void AddOverRanks(Device& device, Communicator& communicator, const std::vector<double>& left, const Buffer<float>& to);

/// Sweep of a distributed grid: each block (subdomain) is in the device memory of one rank, and no rank holds more than
/// its own block. Rays pass from block to block downwind, along several sets of bundles concurrently (numerics.md,
/// section 4.9; Koch, Baker and Alcouffe 1992). The result is that of SweepInMemory on the whole domain, up to the
/// order of summation.
///
/// Rays that leave the domain at the end of a periodic axis enter at its other end after all blocks have been swept.
/// Rays that wrap around an axis transverse to their marching axis enter the same planes again, in further passes with
/// only such rays, until none are left. Rays that wrap around their marching axis enter in the next lap (crossing of
/// the domain), as in AxisSweep.
///
/// Construction and Apply() are collective, with the same rays on all ranks. Light per cell of the faces
/// (SweepRequest::faceIn, Deposit::faceOut) refers to the whole domain and is identical on all ranks.
class SweepInBlocks : public SweepByGroups
{
public:
  /// @param communicator, partition, sigma_t  must outlive this object
  /// @param layout  layout of this rank's block
  /// @param request  its member `box` is ignored: the whole domain is swept. On ranks without voxels its member
  ///   `angular` may be null
  /// @param workspace  must outlive this object; may be shared by sweeps that never run concurrently
  /// @param mostRays  maximum number of rays that cross a block together; 0: the number that minimises the simulated
  /// time of the sweep (FastestParts)
  /// @throws InvalidInput if blocks wait for each other's rays in a cycle
  SweepInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition, const VolumeLayout& layout,
    const Buffer<float>& sigma_t, const std::array<bool, 3>& periodic, const SweepRequest& request,
    BlockWorkspace& workspace, int mostRays = 0);

  /// Sweeps the whole domain once. Collective.
  /// @return the tally summed over all ranks, identical on each
  /// @throws on every rank, if any rank throws
  SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) override;
  void Forget() override;

  const SweepSchedule& Schedule() const { return this->TheSchedule; }
  /// Number of bytes of host memory for the rays at the faces of this rank's block, for one set of bundles
  std::size_t FaceBytes() const;

private:
  using Contacts = std::vector<BlockContact>;
  /// Rays of a set of bundles that wrap around a periodic axis from one rank (possibly this one) to this rank.
  struct Around
  {
    Contacts aside, ahead;
    /// Rays that wrap around an axis transverse to the marching axis; they enter in the next pass
    std::vector<float> rays;
    /// Per group of channels: rays that wrap around the marching axis; they enter in the next lap
    std::vector<std::vector<float>> waiting;
  };
  struct Task
  {
    std::unique_ptr<BlockSweep> sweep;
    /// Contacts (sets of shared voxel faces) within the domain. senders: for each rank, those through which it sends
    /// rays to this block; receivers: those through which it receives rays from this block
    std::vector<Contacts> senders, receivers;
    std::vector<Around> aroundFrom; ///< rays that reach this rank around a periodic axis, per sending rank
    /// Contacts around periodic axes, per receiving rank: first around the transverse axes, then around the marching
    /// axis
    std::vector<std::array<Contacts, 2>> aroundTo;
  };
  enum class State
  {
    Lit,
    Dark,  ///< no ray carries any power: the message contains no rays
    Failed ///< the sending rank has thrown
  };
  Task MakeTask(const ParallelBundles& rays, BlockWorkspace& workspace) const;
  static SweepRequest OfWholeDomain(SweepRequest request);
  std::size_t FirstCell(const SweepVolume& volume) const;
  bool CountsPowerIn() const;
  /// Inputs and counters of the sweep of one group of channels.
  struct Sweeping
  {
    const SweepVolume& volume;
    const SweepBoundary& boundary;
    LightByCells cells = {};
    std::size_t group = 0;
    int lap = 0;
    std::array<bool, 3> goesOn = {}; ///< whether rays that march along each axis take part in this lap
    bool again = false;              ///< whether this pass carries only rays that have wrapped around a transverse axis
    SweepTally tally = {};
    /// For each periodic marching axis: power of the rays that left the domain at its end in this lap, W
    std::array<Rgb, 3> ahead = {};
  };
  SweepTally ApplyGroup(
    std::size_t group, const SweepVolume& volume, const SweepBoundary& boundary, const Monitor& monitor) override;
  bool SweepLap(Sweeping& sweeping, const Monitor& monitor);
  bool SweepPass(Sweeping& sweeping, const Monitor& monitor);
  void SweepTask(int number, Sweeping& sweeping, const Monitor& monitor);
  State Enter(
    Task& task, const std::vector<std::vector<float>>& messages, const Sweeping& sweeping, RaysAtFaces& rays) const;
  State EnterFromAround(Task& task, const Sweeping& sweeping, RaysAtFaces& rays) const;
  void SendOn(int number, State state, const RaysAtFaces& rays);
  bool TakeFromAround(const Sweeping& sweeping);
  bool IsAnyPeriodic() const { return this->Periodic[0] || this->Periodic[1] || this->Periodic[2]; }
  /// Number of laps around the axis in which rays start: 1 unless the axis is periodic and short
  int Laps(int axis) const;

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  std::array<bool, 3> Periodic;
  BlockWorkspace& Workspace;
  std::vector<ParallelBundles> Parts;
  SweepSchedule TheSchedule;
  /// Tasks of this rank: sweeps of its block, each along one set of bundles; Tasks[i] belongs to the set Parts[i]
  std::vector<Task> Tasks;

  // State of the sweep in progress.
  std::exception_ptr Error; ///< error on this rank; null: none
  /// Incident radiance per cell of the domain's faces, SweepRequest::faceIn; empty: no such light, or all of it is
  /// zero
  std::vector<float> FaceIn;
  /// Power that left from this rank's block through each cell of the domain's faces, W; empty: not summed
  std::vector<double> Left;
};
}
