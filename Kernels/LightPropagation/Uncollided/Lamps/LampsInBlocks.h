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
/// The uncollided flux of point, spot and rectangle lamps on a grid that is divided among ranks, with the same beams as
/// DepositLamp() (LampBeams.h). A beam that leaves a block is sent to the rank of the block that it enters
/// (numerics.md, section 4.9). A beam covers up to four voxels, some of which may belong to another rank: each rank
/// holds sigma_t of its block and a halo of two voxels, and sends its beams' deposits in the halo to their owners, in
/// fixed point.
///
/// Deposits agree with those of DepositLamp() bit for bit, except for the final correction of the power, which is a sum
/// in another order, and, around periodic axes, except for beams with less than 1e-7 of their initial power, which are
/// dropped.
class LampsInBlocks
{
public:
  /// Collective.
  /// @param communicator, partition  must outlive this object
  /// @param layout  of the rank's block
  LampsInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const std::array<bool, 3>& periodic, const VolumeLayout& layout, const Buffer<float>& sigma_t);

  /// As DepositLamp(). Collective.
  /// @param volume  the rank's block; the face cells of its deposit are those of the whole grid
  /// @return tally of all ranks
  SweepTally Deposit(const SweepVolume& volume, const Light& light, const Monitor& monitor);

private:
  class Beams;
  bool Has() const { return this->Own.VoxelCount() > 0; }

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  VoxelBox Own;
  Halo Stored; ///< the block and its halo of two voxels
  tyndall::Rounds Rounds;
  std::size_t OwnStride; ///< stride of one sigma_t of the block in its layout
  Buffer<float> SigmaT;  ///< 1/length, of the stored voxels, one sigma_t array after the other
};
}
