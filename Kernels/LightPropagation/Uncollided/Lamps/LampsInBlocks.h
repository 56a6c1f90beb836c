#pragma once

#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/Halo.h"
#include "Distribution/Rounds.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "Lights/Lights.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// Follows the light of point, spot and rectangle lamps through a grid that is spread over ranks, as DepositLamp
/// (LampBeams.h) does in one memory, with the same beams: those that leave a block are handed to the rank whose block
/// they come to (numerics.md, section 4.9). A beam lies over up to four voxels, some of which may be another rank's:
/// each rank knows sigma_t of two voxels round its block, and gives what its beams put down there to their owners, in
/// fixed point, so that deposits are those of DepositLamp bit for bit but for the last correction of the power, whose
/// sum has another order; round periodic axes but for what is below 1e-7 of a beam, which ends there.
class LampsInBlocks
{
public:
  /// All ranks make one together.
  /// @param communicator, partition  must stay
  /// @param layout  of the rank's block
  LampsInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const std::array<bool, 3>& periodic, const VolumeLayout& layout, const Buffer<float>& sigma_t);

  /// As DepositLamp. All ranks call it.
  /// @param volume  the rank's block; of its deposit cells of faces are those of the whole grid
  /// @return of all ranks together
  SweepTally Deposit(const SweepVolume& volume, const Light& light, const Monitor& monitor);

private:
  class Beams;
  bool Has() const { return this->Own.VoxelCount() > 0; }

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  VoxelBox Own;
  Halo Stored; ///< the block and what its beams may reach beside it
  tyndall::Rounds Rounds;
  std::size_t OwnStride; ///< of an extinction of the block in its layout, and
  Buffer<float> SigmaT;  ///< 1/length, of the stored voxels, one extinction after the other
};
}
