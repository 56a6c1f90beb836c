#pragma once

#include "Device/Device.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LightPropagation/Sweep/BeyondFaces.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Gives each rank what the others, or round a periodic axis its own block, have beyond the faces of its block: a value
/// of each voxel that touches one, and channel.
class AcrossFaces
{
public:
  /// @param layout  of this rank's block; must stay, as do device, communicator and partition
  AcrossFaces(Device& device, Communicator& communicator, const BlockPartition& partition, const VolumeLayout& layout,
    const std::array<bool, 3>& periodic);

  /// All ranks call it together.
  /// @param byFaces  [channel][face][stride] of the block
  /// @return of which the values are this object's, until the next time
  BeyondFaces Fetch(const Buffer<float>& byFaces);

private:
  VoxelBox LayerBeyond(const VoxelBox& block, int face) const;

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  const VolumeLayout& Layout;
  const std::array<bool, 3> Periodic;
  std::array<std::vector<VoxelBox>, 6> Wanted; ///< by face and rank
  BeyondFacesInfo Info;
  Buffer<float> Values;
};
}
