#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/Rounds.h"
#include "Medium/Medium.h"
#include "Photons/Distributed/TurnsInBlocks.h"
#include "Photons/Importance/PilotLight.h"
#include "Photons/Photons.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tyndall
{
/// Marches photons through a medium that is spread over ranks by blocks, as PhotonMarcher marches them through the
/// whole. All ranks make one and call it together.
///
/// A photon that leaves a block is handed, as it is, to the rank whose block it enters, and goes on there (numerics.md,
/// section 12.6), with the random numbers that it has drawn where it is scattered: its way does not depend on the
/// blocks, and what voxels gain is in fixed point. The light is that of PhotonMarcher, bit for bit, whatever the number
/// of ranks; powers of scattered light, which are sums of floats, to 1e-9. No rank holds more of the medium than its
/// block and, of the refractive index, some voxels round it: by steps of order 4 of an octree 20 or more. Of an octree
/// each has the nodes of the whole grid, in bricks of 8^3 voxels, of which those that lie in one node take 4 bytes:
/// steps look into the next node, which may lie anywhere.
class PhotonMarcherInBlocks
{
public:
  /// @param medium  of the rank's block, with the grid that partition.OwnGrid() has; looked at by nobody where that has
  ///   no voxels. As all arrays, read in the constructor only.
  /// @param ior     of the block's voxels, one component; null values: 1
  /// @param communicator, partition  must stay
  /// @param levels  of the octree of the whole grid, those of the block's voxels; null: there is none, on all ranks
  /// @param settings  the same on all ranks. `byBricks` does not matter: light is kept voxel by voxel
  /// @throws InvalidInput  on every rank, where one of them has an input that PhotonMarcher refuses, where they
  ///   disagree, or where something is asked for that is not carried from rank to rank: names it
  /// @throws DeviceError  on every rank what one of them throws
  PhotonMarcherInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const Medium& medium, const Field& ior, const MarchSettings& settings, const std::uint8_t* levels = nullptr);
  ~PhotonMarcherInBlocks();

  /// @param share  some of the photons: all of them are those of rank 0, then those of rank 1, and so on
  /// @return arrays of the rank's block, none where that is empty; balance, face powers and all counts are of the whole
  /// @throws InvalidInput, DeviceError, Aborted  on every rank what one of them throws
  PhotonLight March(const std::vector<Photon>& share, const Monitor& monitor = {});

  /// The same light, of photons that march in turns. Without batches, and of one order.
  /// @throws InvalidInput  also where settings ask for batches or other orders than 1
  PhotonLight MarchByTurns(const std::vector<Photon>& share, const TurnsInBlocks& turns, const Monitor& monitor = {});

  /// The ways of so many of all photons, spread evenly (ChooseEvenly), corner by corner, each in one piece, as
  /// PhotonMarcher has them.
  /// @return of rank 0 all of them, of the others none
  std::vector<PhotonPath> Paths(const std::vector<Photon>& share, std::size_t count);

  /// PhotonMarcher::Gather of photons that all ranks have alike: the light of the whole, on each rank.
  PilotLight Gather(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins,
    const std::array<int, 3>& cells, const Monitor& monitor = {});

  const RoundsTraffic& Traffic() const; ///< of the last march, of this rank

private:
  class Rank;
  std::unique_ptr<Rank> Inside;
};

/// What is asked for that keeps ranks from marching photons in blocks, in words for an error; empty: nothing does.
std::string NotInBlocks(const MarchSettings& settings);
}
