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
/// How photons over ranks march a few voxels at a time, so that the light that they leave is used in between, where
/// MarchTurns has it used beside them. All ranks call each of these together.
struct TurnsInBlocks
{
  int stretches = 16; ///< of a photon's way in a turn, from voxel wall to voxel wall; 0: to its end
  /// Called first. @param channels  of the light that `take` will be given
  std::function<void(const PackedPhotons& photons, int channels)> begin;
  std::function<void()> meanwhile; ///< after each turn but the first: what is done with the light of the turns before
  /// Takes over the light that photons have left since they began.
  /// @param fluence  W / length^2 of the rank's voxels, [voxel][channel]; empty where it has none
  std::function<void(const Buffer<float>& fluence)> take;
};

/// One rank's photons, which march by turns and wait between them.
class WaitingPhotons
{
public:
  using Ended = std::function<void(const std::vector<cl_int>& ends)>;

  /// What is given must stay.
  /// @param march  null: the rank has no voxels
  /// @param ended  takes the ends of photons that have come to them, and of those that wait or have left the block
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

  /// March photons to their ends in turns, those of all ranks as far as each other. All ranks call it.
  /// @param limit  walls and turns of a photon at most
  /// @param show  makes fluence of the sums so far
  /// @throws  on every rank what one of them throws; Aborted: the sums are of a part of the ways then
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
