#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LightPropagation/Distributed/BlockSweep.h"
#include "LightPropagation/Distributed/SweepSchedule.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <exception>
#include <memory>
#include <vector>

namespace tyndall
{
/// The sweep of a grid whose blocks lie on several ranks, each in one device's memory: no rank holds more than its own.
/// Rays go from block to block in the order that light does, along some bundles while others are under way elsewhere
/// (numerics.md, section 4.9; Koch, Baker and Alcouffe 1992). The same light as that of SweepInMemory in the whole
/// grid, but for the order of sums.
///
/// All ranks make one, of the same rays, and apply it together. No axis is periodic; light comes in alike through all
/// cells of a face.
class SweepInBlocks : public SweepOperator
{
public:
  /// @param communicator, partition, sigma_t  must stay
  /// @param layout  of the rank's own block
  /// @param request  its box is not looked at: all is swept. Ranks without voxels need no angular values
  /// @param workspace  must stay; shared by sweeps that never run at the same time
  /// @param mostRays  that go through a block at once; 0: as many as end the sweep soonest (FastestParts)
  /// @throws InvalidInput where the request has what this cannot do, or blocks wait for each other
  SweepInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition, const VolumeLayout& layout,
    const Buffer<float>& sigma_t, const SweepRequest& request, BlockWorkspace& workspace, int mostRays = 0);

  /// @return of all ranks together, the same on each
  /// @throws on every rank what any of them throws
  SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) override;
  void Forget() override {} ///< nothing goes round

  const SweepSchedule& Schedule() const { return this->TheSchedule; }
  std::size_t FaceBytes() const; ///< on the host, of the rays at faces of one set of bundles

private:
  struct Task
  {
    std::unique_ptr<BlockSweep> sweep;
    std::vector<std::vector<BlockContact>> senders, receivers; ///< one list for each rank there is contact with
  };
  enum class State
  {
    Lit,
    Dark,  ///< no ray carries anything
    Failed ///< the rank that should send them has thrown
  };
  Task MakeTask(const ParallelBundles& rays, BlockWorkspace& workspace);
  SweepVolume VolumeOf(const ChannelGroup& group, const Buffer<float>* source) const;
  bool CountsPowerIn() const;
  void SweepTask(int number, const SweepVolume& volume, const SweepBoundary& boundary, SweepTally& tally,
    std::exception_ptr& error, const Monitor& monitor);
  State Enter(const Task& task, const std::vector<std::vector<float>>& messages, const SweepBoundary& boundary,
    RaysAtFaces& rays) const;

  Device& TheDevice;
  Communicator& Others;
  const BlockPartition& Partition;
  VolumeLayout Layout;
  const Buffer<float>& SigmaT;
  Deposit To;
  const AngularValues* Angular;
  const Buffer<float>* OctantSource;
  std::vector<ParallelBundles> Parts;
  SweepSchedule TheSchedule;
  std::vector<Task> Tasks; ///< of this rank, as the parts
};
}
