#pragma once

#include "Device/Device.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LightPropagation/Sweep/BeyondFacesShared.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Values of the voxels that touch a block's faces from outside: the value of each such voxel at the face that it
/// shares with the block. They are taken from an array with one value per voxel and face, such as
/// Deposit::partialCurrents.
struct BeyondFaces
{
  /// Values [channel][face][cell of the face, its lower axis fastest]; null: the block is the whole domain
  const Buffer<float>* values = nullptr;
  BeyondFacesInfo info = { { -1, -1, -1, -1, -1, -1 }, 0 };
};

/// Fetches the values of voxels beyond the faces of a block from the ranks that own them. Collective. The result is
/// valid until the next call.
using FetchBeyondFaces = std::function<BeyondFaces(const Buffer<float>& byFaces)>;

/// Halo exchange of face values. For every voxel that touches a face of its block from outside, and every channel, each
/// rank receives the voxel's value at that face from the rank that owns the voxel. Around a periodic axis, this may be
/// the same rank.
class AcrossFaces
{
public:
  /// @param layout  layout of this rank's block; must outlive this object, as must device, communicator and partition
  AcrossFaces(Device& device, Communicator& communicator, const BlockPartition& partition, const VolumeLayout& layout,
    const std::array<bool, 3>& periodic);

  /// Fetches the values beyond the faces of this rank's block. Collective.
  /// @param byFaces  values of the block's voxels at each of their faces, [channel][face][voxel]
  /// @return values owned by this object, valid until the next call
  BeyondFaces Fetch(const Buffer<float>& byFaces);

private:
  VoxelBox LayerBeyond(const VoxelBox& block, int face) const;

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  const VolumeLayout& Layout;
  const std::array<bool, 3> Periodic;
  std::array<std::vector<VoxelBox>, 6> Wanted; ///< voxels needed from each rank, [face][rank]
  BeyondFacesInfo Info;
  Buffer<float> Values;
};
}
