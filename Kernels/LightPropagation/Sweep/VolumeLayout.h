#pragma once

#include "LightPropagation/Sweep/SweepVolume.h"
#include "Medium/Grid.h"

#include <vector>

namespace tyndall
{
/// Channels that share one sigma_t: they are swept together.
struct ChannelGroup
{
  int first = 0;
  int count = 1;
};

/// How arrays over voxels lie in the device's memory: [channel][stride], the stride a whole number of the widest
/// vectors.
struct VolumeLayout
{
  Grid grid;
  int channels = 1;
  bool sharedExtinction = true; ///< of all channels; else each has its own, and there are three

  std::size_t Stride() const { return (this->grid.VoxelCount() + SweepPadding - 1) / SweepPadding * SweepPadding; }
  /// Floats of an array of `parts` values a voxel and channel, with what vectors may read beyond it.
  std::size_t Floats(int parts = 1) const { return parts * this->Stride() * this->channels + SweepPadding; }
  std::size_t ExtinctionFirst(int channel) const { return this->sharedExtinction ? 0 : channel * this->Stride(); }

  std::vector<ChannelGroup> Groups() const
  {
    return this->sharedExtinction ? std::vector<ChannelGroup>{ { 0, this->channels } }
                                  : std::vector<ChannelGroup>{ { 0, 1 }, { 1, 1 }, { 2, 1 } };
  }
};

/// The channels of a group as a sweep sees them, without source and deposit.
inline SweepVolume GroupVolume(const VolumeLayout& layout, const ChannelGroup& group, const Buffer<float>& sigma_t)
{
  SweepVolume volume;
  volume.grid = layout.grid;
  volume.channels = group.count;
  volume.stride = layout.Stride();
  volume.sigma_t = &sigma_t;
  volume.sigma_t_first = layout.ExtinctionFirst(group.first);
  volume.first = group.first * layout.Stride();
  return volume;
}
}
