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
/// Halo exchange of face values: gives each rank, for every voxel that touches a face of its block from outside and
/// every channel, a value from the rank that owns the voxel (around a periodic axis possibly the rank itself).
class AcrossFaces
{
public:
  /// @param layout  layout of this rank's block; must outlive this object, as must device, communicator and partition
  AcrossFaces(Device& device, Communicator& communicator, const BlockPartition& partition, const VolumeLayout& layout,
    const std::array<bool, 3>& periodic);

  /// Collective.
  /// @param byFaces  [channel][face][stride] values of the block
  /// @return values owned by this object, valid until the next call
  BeyondFaces Fetch(const Buffer<float>& byFaces);

private:
  VoxelBox LayerBeyond(const VoxelBox& block, int face) const;

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  const VolumeLayout& Layout;
  const std::array<bool, 3> Periodic;
  std::array<std::vector<VoxelBox>, 6> Wanted; ///< voxels needed from each rank, by face and rank
  BeyondFacesInfo Info;
  Buffer<float> Values;
};
}
