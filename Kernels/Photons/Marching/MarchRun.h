#pragma once

#include "Device/Monitor.h"
#include "Photons/Marching/MarchLaunch.h"
#include "Photons/Marching/MarchShared.h"
#include "Photons/Marching/MarchTurns.h"

#include <vector>

namespace tyndall
{
inline const int* WhereIs(const PhotonOnItsWay& photon)
{
  return photon.way.voxel;
}

/// Marches photons through what a rank has of a grid: to their ends or, in a block of it, as far as that goes.
class MarchRun
{
public:
  /// @param medium, target  must stay
  /// @param packed  its channels are those of all photons
  MarchRun(const MarchMedium& medium, const MarchSums& target, const PackedPhotons& packed);

  /// What became of photons.
  struct Outcome
  {
    std::vector<cl_int> ends;         ///< PhotonEnd and powers of each (Tally)
    std::vector<PhotonOnItsWay> gone; ///< into other blocks, or waiting in this one, in any order
  };
  /// From now on photons in a block wait after so many stretches of their ways, or in the last turn are given up.
  void GoAsFarAs(const TurnSchedule& turn);

  /// Of photons that set off in the block.
  /// @param marks  by which they count, or none
  /// @throws Aborted: the sums are of a part of the photons then
  Outcome Start(const PackedPhotons& photons, const std::vector<cl_ulong>& marks, const Monitor& monitor);
  /// Of photons that have come from other blocks, or waited. @throws Aborted
  Outcome Resume(std::vector<PhotonOnItsWay> arrived, const Monitor& monitor);

private:
  struct Marched;
  Outcome March(const Marched& photons, const std::vector<int>& batchBegin, const Monitor& monitor);
  void MarchBatch(const Marched& photons, int batch, std::size_t begin, std::size_t end, const Monitor& monitor,
    std::vector<PhotonOnItsWay>& gone);

  const MarchMedium& Medium;
  MarchInfo Info;
  const MarchSums& Target;
  int Channels;
  cl::Kernel Kernel;
};
}
