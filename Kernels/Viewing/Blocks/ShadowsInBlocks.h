#pragma once

#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/VoxelBox.h"
#include "Viewing/MediumRayCaster.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/ViewShared.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace tyndall
{
/// Direct light of lamps in the voxels of a domain that is decomposed into blocks: shadow rays cross the blocks of
/// other ranks.
///
/// Each rank's voxels are processed in portions. Every rank whose block is crossed by shadow rays of a portion computes
/// its part of their optical length and sends it to the rank that owns the voxels, which adds up the parts in the order
/// of ranks. The owner acknowledges each part, and the sender sends no further part, to any rank, before: a rank thus
/// stores two computed portions and one received portion, for any number of ranks.
///
/// The constructor and Find are collective; ranks without voxels take part.
class ShadowsInBlocks
{
public:
  /// Largest number of voxels of a portion (one row may exceed it); 12 bytes each.
  static constexpr std::size_t PortionVoxels = 65536;

  /// @param communicator, partition, held  must outlive this object
  /// @param held  for each rank, the voxels its arrays cover, ghost cells included
  /// @param own   caster of this rank's block; null: it has no voxels
  /// @param portion  voxels
  /// @throws InvalidInput  on all ranks, if the number of lights differs between ranks
  ShadowsInBlocks(Communicator& communicator, const BlockPartition& partition, const std::vector<VoxelBox>& held,
    MediumRayCaster* own, std::size_t portion = PortionVoxels);

  bool AreThere() const { return !this->Lights.empty(); } ///< whether there are lights; the same on all ranks

  /// Computes the direct irradiance of each light in each voxel of this block, and the radiance that is scattered from
  /// it towards the eye. Collective.
  /// @throws  collective error: what one rank throws, all throw
  void Find(const Camera& camera, const Monitor& monitor);

private:
  struct Portion
  {
    int light, rank;
    VoxelBox voxels;
  };

  void Follow(int light, const Camera& camera, const Monitor& monitor);
  bool LeadsThrough(const Portion& portion, int rank) const;
  void SendDepths(const Portion& portion, const Monitor& monitor);
  void SeeLight(const Portion& portion, const Camera& camera);
  void AwaitReceipt();

  Communicator& Comm;
  const BlockPartition& Partition;
  const std::vector<VoxelBox>& Held;
  MediumRayCaster* Own;
  std::size_t VoxelsAtOnce;
  std::vector<SmallLight> Lights; ///< the same on all ranks, which derive the order of messages from them
  HeldFailure Failure;            ///< error while processing the current light
  std::optional<int> Receiver;    ///< rank that has not yet acknowledged the last portion
};
}
