#include "LightPropagation/Sweep/Pipelined/AcrossFaces.h"

#include "Distribution/BoxExchange.h"

#include <algorithm>
#include <cstddef>

namespace tyndall
{
AcrossFaces::AcrossFaces(Device& device, Communicator& communicator, const BlockPartition& partition,
  const VolumeLayout& layout, const std::array<bool, 3>& periodic)
  : TheDevice(device)
  , Comm(communicator)
  , Partition(partition)
  , Layout(layout)
  , Periodic(periodic)
  , Info{ {}, 0 }
{
  for (int face = 0; face < 6; ++face)
  {
    for (const VoxelBox& block : partition.blocks)
    {
      this->Wanted[face].push_back(this->LayerBeyond(block, face));
    }
    const std::size_t cells = this->Wanted[face][communicator.Rank()].VoxelCount();
    this->Info.first[face] = cells > 0 ? static_cast<int>(this->Info.stride) : -1;
    this->Info.stride += cells;
  }
}

/// Layer of voxels that touches a block's face from outside; empty at a face of the domain.
VoxelBox AcrossFaces::LayerBeyond(const VoxelBox& block, int face) const
{
  const int axis = face / 2, size = this->Partition.whole.size[axis];
  int beyond = face % 2 == 1 ? EndOf(block, axis) : block.first[axis] - 1;
  beyond = this->Periodic[axis] ? (beyond + size) % size : beyond;
  if (block.VoxelCount() == 0 || beyond < 0 || beyond >= size)
  {
    return {};
  }
  VoxelBox layer = block;
  layer.first[axis] = beyond;
  layer.size[axis] = 1;
  return layer;
}

BeyondFaces AcrossFaces::Fetch(const Buffer<float>& byFaces)
{
  const int channels = this->Layout.channels;
  const std::size_t voxels = this->Layout.grid.VoxelCount(), stride = this->Layout.Stride();
  std::vector<float> all, own, values;
  this->Comm.Collective([&] {
    all = byFaces.Read();
    own.resize(voxels * channels);
    values.resize(std::max<std::size_t>(this->Info.stride * channels, 1));
  });
  for (int face = 0; face < 6; ++face)
  {
    const std::size_t touching = face ^ 1;
    for (std::size_t i = 0; i < own.size(); ++i)
    {
      own[i] = all[(6 * (i % channels) + touching) * stride + i / channels];
    }
    const std::vector<float> found = ValuesInBox(this->Comm, this->Partition, this->Wanted[face], own, channels);
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      values[i % channels * this->Info.stride + this->Info.first[face] + i / channels] = found[i];
    }
  }
  this->Comm.Collective([&] { this->Values = Buffer<float>(this->TheDevice, values, "light beyond a block's faces"); });
  return { &this->Values, this->Info };
}
}
