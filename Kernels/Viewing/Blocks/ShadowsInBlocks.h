#pragma once

#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/HeldFailure.h"
#include "Medium/VoxelBox.h"
#include "Viewing/MediumRayCaster.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/ViewShared.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace tyndall
{
/// Light that comes straight from lamps to the voxels of a medium that is spread over ranks by blocks: shadow rays go
/// through the blocks of others.
///
/// The voxels of each rank are gone through in portions. Ranks through whose blocks ways lead from a portion to a light
/// find their part of the optical length and send it to the rank whose voxels these are, which adds the parts up in the
/// order of ranks. It says that it has one before its sender gives it, or anyone else, the next: a rank holds two
/// portions that it has found and one that it has been sent, however many ranks there are.
///
/// All ranks construct it and call Find together, also one without voxels.
class ShadowsInBlocks
{
public:
  /// Voxels of a portion, at most, but for a row that has more; 12 bytes each.
  static constexpr std::size_t PortionVoxels = 65536;

  /// @param communicator, partition, held  must stay
  /// @param held  by rank, the voxels that its arrays have
  /// @param own   of this rank's block; null: it has no voxels
  /// @param portion  voxels
  /// @throws InvalidInput  on all ranks where one has not as many lights as another
  ShadowsInBlocks(Communicator& communicator, const BlockPartition& partition, const std::vector<VoxelBox>& held,
    MediumRayCaster* own, std::size_t portion = PortionVoxels);

  bool AreThere() const { return !this->Lights.empty(); } ///< lights; the same on all

  /// What light comes straight from each light to each voxel of this block, and what is scattered of it towards the
  /// eye.
  /// @throws on all ranks what one of them throws
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
  std::vector<SmallLight> Lights; ///< the same on all ranks, which decide by them who waits for whom
  HeldFailure Failure;            ///< of a light
  std::optional<int> Receiver;    ///< who has not said yet that it has the last portion
};
}
