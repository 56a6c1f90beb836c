#pragma once

#include "Distribution/Rounds.h"
#include "Photons/Distributed/BlockPaths.h"

#include <vector>

namespace tyndall
{
/// The ways of photons through a medium that is spread over ranks by blocks, each put together of its parts.
class PathsInBlocks
{
public:
  /// @param through  the rank's block; null: it has none
  PathsInBlocks(Communicator& communicator, const BlockPartition& partition, const MarchMedium* through);

  /// All ranks call it.
  /// @param photons  the same on all ranks
  /// @param numbers  of these
  /// @return of rank 0 the paths, by their photons' numbers, ascending; of the others none
  std::vector<PhotonPath> Trace(
    const std::vector<Photon>& photons, const std::vector<std::size_t>& numbers, int eventLimit);

private:
  struct Parts;
  Parts TraceParts(const PackedPhotons& packed);

  Communicator& Comm;
  const BlockPartition& Partition;
  const MarchMedium* Through;
};
}
