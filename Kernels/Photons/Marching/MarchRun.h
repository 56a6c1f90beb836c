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

/// Marches photons through a rank's part of a grid: to their ends or, in a block, until they leave it.
class MarchRun
{
public:
  /// @param medium, target  must outlive this
  /// @param packed  gives the number of channels, the same for all photons
  MarchRun(const MarchMedium& medium, const MarchSums& target, const PackedPhotons& packed);

  /// Result of a march.
  struct Outcome
  {
    std::vector<cl_int> ends;         ///< PhotonEnd and powers of each photon (Tally)
    std::vector<PhotonOnItsWay> gone; ///< photons that left for other blocks, or wait in this one, in any order
  };
  /// In later marches, photons in a block wait after turn.gone path segments in all; in the last turn they are given up
  /// there.
  void GoAsFarAs(const TurnSchedule& turn);

  /// Marches photons that start in the block.
  /// @param marks  counting marks of the photons, or none
  /// @throws Aborted: the sums then hold only a part of the photons
  Outcome Start(const PackedPhotons& photons, const std::vector<cl_ulong>& marks, const Monitor& monitor);
  /// Marches photons that arrived from other blocks, or waited. @throws Aborted
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
