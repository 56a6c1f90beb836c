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
/// Adds what left through each cell of the whole grid's faces on any rank, W, to an array that all ranks have. All call
/// it.
void AddOverRanks(Device& device, Communicator& communicator, const std::vector<double>& left, const Buffer<float>& to);

/// The sweep of a grid whose blocks lie on several ranks, each in one device's memory: no rank holds more than its own.
/// Rays go from block to block in the order that light does, along some bundles while others are under way elsewhere
/// (numerics.md, section 4.9; Koch, Baker and Alcouffe 1992). The same light as that of SweepInMemory in the whole
/// grid, but for the order of sums.
///
/// Round a periodic axis rays that leave the grid come in at its other end when all blocks have been swept: sideways in
/// the same planes, in another pass of such rays alone, until there are none; ahead in the next lap, as AxisSweep has
/// it.
///
/// All ranks make one, of the same rays, and apply it together. Light by cells of faces
/// (SweepRequest::faceIn, Deposit::faceOut) is that of the whole grid's, and the same on all ranks.
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
    const Buffer<float>& sigma_t, const std::array<bool, 3>& periodic, const SweepRequest& request,
    BlockWorkspace& workspace, int mostRays = 0);

  /// @return of all ranks together, the same on each
  /// @throws on every rank what any of them throws
  SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) override;
  void Forget() override;

  const SweepSchedule& Schedule() const { return this->TheSchedule; }
  std::size_t FaceBytes() const; ///< on the host, of the rays at faces of one set of bundles

private:
  using Contacts = std::vector<BlockContact>;
  /// Rays of a set of bundles that go round a periodic axis from one rank, which may be this one, to this one.
  struct Around
  {
    Contacts aside, ahead;
    std::vector<float> rays;                 ///< aside, that come in with the next pass
    std::vector<std::vector<float>> waiting; ///< ahead, that come in with the next lap, by group of channels
  };
  struct Task
  {
    std::unique_ptr<BlockSweep> sweep;
    std::vector<Contacts> senders, receivers;      ///< one list for each rank there is contact with
    std::vector<Around> aroundFrom;                ///< the same, round periodic axes
    std::vector<std::array<Contacts, 2>> aroundTo; ///< aside and ahead
  };
  enum class State
  {
    Lit,
    Dark,  ///< no ray carries anything
    Failed ///< the rank that should send them has thrown
  };
  Task MakeTask(const ParallelBundles& rays, BlockWorkspace& workspace) const;
  SweepVolume VolumeOf(const ChannelGroup& group, const Buffer<float>* source) const;
  bool CountsPowerIn() const;
  /// What goes into a sweep of some channels, and what is counted.
  struct Sweeping
  {
    SweepVolume volume;
    SweepBoundary boundary;
    LightByCells cells;
    std::size_t group = 0;
    int lap = 0;
    std::array<bool, 3> goesOn = {}; ///< axes whose rays are in this lap
    bool again = false;              ///< a pass of rays that go round sideways
    SweepTally tally;
    std::array<Rgb, 3> ahead = {}; ///< W that this lap left at the ends of periodic axes
  };
  void SweepGroup(Sweeping& sweeping, std::exception_ptr& error, const Monitor& monitor);
  bool SweepLap(Sweeping& sweeping, std::exception_ptr& error, const Monitor& monitor);
  bool SweepPass(Sweeping& sweeping, std::exception_ptr& error, const Monitor& monitor);
  void SweepTask(int number, Sweeping& sweeping, std::exception_ptr& error, const Monitor& monitor);
  State Enter(
    Task& task, const std::vector<std::vector<float>>& messages, const Sweeping& sweeping, RaysAtFaces& rays) const;
  State EnterFromAround(Task& task, const Sweeping& sweeping, RaysAtFaces& rays) const;
  void SendOn(int number, State state, const RaysAtFaces& rays);
  bool TakeFromAround(const Sweeping& sweeping, std::exception_ptr& error);
  bool IsAnyPeriodic() const { return this->Periodic[0] || this->Periodic[1] || this->Periodic[2]; }
  int Laps(int axis) const; ///< in which rays start
  void AddToFaces(const std::vector<double>& left) const;

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  VolumeLayout Layout;
  const Buffer<float>& SigmaT;
  std::array<bool, 3> Periodic;
  BlockWorkspace& Workspace;
  int MostPlanes;
  Deposit To;
  const AngularValues* Angular;
  const Buffer<float>* OctantSource;
  const Buffer<float>* FaceIn;
  std::vector<ParallelBundles> Parts;
  SweepSchedule TheSchedule;
  std::vector<Task> Tasks; ///< of this rank, as the parts
};
}
