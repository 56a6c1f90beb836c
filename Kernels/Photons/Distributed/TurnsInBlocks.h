#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/Rounds.h"
#include "Photons/Marching/MarchRun.h"
#include "Photons/Marching/PhotonShares.h"

#include <functional>
#include <vector>

namespace tyndall
{
/// Callbacks for photons that march on several ranks a few voxels per turn. The light deposited so far is used between
/// turns, whereas MarchTurns has it used while photons march. Each callback is called on all ranks together.
struct TurnsInBlocks
{
  /// Path segments of a photon per turn, from voxel wall to voxel wall; 0: one turn to its end.
  int stretches = 16;
  /// Called once, first. @param channels  number of channels of the fluence that `take` receives
  std::function<void(const PackedPhotons& photons, int channels)> begin;
  /// Called after each turn but the first; processes the light of earlier turns.
  std::function<void()> meanwhile;
  /// Receives the light accumulated since the first turn.
  /// @param fluence  W / length^2 in the rank's voxels, [voxel][channel]; empty if it has no voxels
  std::function<void(const Buffer<float>& fluence)> take;
};

/// The photons of one rank, marched in turns; between turns they wait on the host.
class WaitingPhotons
{
public:
  using Ended = std::function<void(const std::vector<cl_int>& ends)>;

  /// Keeps references to all arguments.
  /// @param march  null if the rank has no voxels
  /// @param ended  receives the PhotonEnd records of photons that have ended, wait, or have left the block
  WaitingPhotons(Communicator& communicator, Rounds& rounds, const VoxelBox& own, MarchRun* march,
    const StartingPhotons& starting, const Ended& ended)
    : Comm(communicator)
    , TheRounds(rounds)
    , Own(own)
    , March(march)
    , Starting(starting)
    , TellEnds(ended)
  {
  }

  /// Marches the photons of all ranks to their ends, turn by turn in step. Collective.
  /// @param limit  maximum number of path segments of a photon
  /// @param show  computes the fluence from the sums so far
  /// @throws  on every rank what one of them throws; Aborted: the sums then hold only a part of the paths
  void ToTheirEnds(
    const TurnsInBlocks& turns, int limit, const std::function<const Buffer<float>&()>& show, const Monitor& monitor);

private:
  std::vector<PhotonOnItsWay> Follow(
    const TurnSchedule& turn, int round, std::vector<PhotonOnItsWay>&& arrived, const Monitor& monitor);
  void KeepThoseThatWait(const TurnSchedule& turn, std::vector<PhotonOnItsWay>& photons);

  Communicator& Comm;
  Rounds& TheRounds;
  const VoxelBox& Own;
  MarchRun* const March;
  const StartingPhotons& Starting;
  const Ended TellEnds;
  bool Started = false;
  std::vector<PhotonOnItsWay> Waiting;
};
}
