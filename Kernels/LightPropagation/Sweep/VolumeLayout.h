#pragma once

#include "Device/Buffer.h"
#include "Device/HostMemory.h"
#include "Device/HostThreads.h"
#include "LightPropagation/Sweep/MomentPlacesShared.h"
#include "Medium/Grid.h"

#include <algorithm>
#include <vector>

namespace tyndall
{
/// Width of the widest vector in any kernel, floats.
constexpr std::size_t SweepPadding = 16;

/// Channels that share one sigma_t and are swept together.
struct ChannelGroup
{
  int first = 0;
  int count = 1;
};

/// Memory layout of arrays over voxels on the device: [channel][stride], voxels x fastest. The stride is the voxel
/// count rounded up to whole vectors; the padding is zero. Buffers are SweepPadding floats longer, so that a full
/// vector may be read from any position in them.
struct VolumeLayout
{
  Grid grid;
  int channels = 1;
  /// One extinction for all channels; false: three channels, each with its own extinction
  bool sharedExtinction = true;

  std::size_t Stride() const { return (this->grid.VoxelCount() + SweepPadding - 1) / SweepPadding * SweepPadding; }
  /// Floats of one quantity, without padding at the end
  std::size_t Values() const { return this->channels * this->Stride(); }
  /// Floats of an array with `parts` values per voxel and channel, including the padding that vectors may read.
  std::size_t Floats(int parts = 1) const { return this->FloatsOf(parts * this->channels); }
  /// The same for `channelCount` channels.
  std::size_t FloatsOf(int channelCount) const { return channelCount * this->Stride() + SweepPadding; }
  /// Layout of an array with angular moments.
  MomentPlaces Places(int functions) const
  {
    const std::size_t groups = (this->grid.size[0] + MomentGroup - 1) / MomentGroup;
    const std::size_t rows = static_cast<std::size_t>(this->grid.size[1]) * this->grid.size[2] * this->channels;
    MomentPlaces places = {};
    places.second = this->Values();
    places.beams = places.second + rows * groups * (functions - 1) * MomentGroup;
    places.sizeX = this->grid.size[0];
    places.groups = static_cast<int>(groups);
    places.channels = this->channels;
    places.functions = functions;
    return places;
  }
  static std::size_t MomentPlace(const MomentPlaces& places, int function, int channel, std::size_t voxel)
  {
    return MOMENT_PLACE(places, function, channel, voxel / places.sizeX, voxel % places.sizeX);
  }
  /// Channel of the value at index `at` of such an array; not for beams.
  int ChannelOf(const MomentPlaces& places, std::size_t at) const
  {
    const std::size_t ofRow = static_cast<std::size_t>(places.groups) * (places.functions - 1) * MomentGroup;
    return static_cast<int>(at < places.second ? at / this->Stride() : (at - places.second) / ofRow % this->channels);
  }
  /// Floats of an array with angular moments and beams, including padding.
  std::size_t MomentFloats(int functions, int beams = 0) const
  {
    return this->Places(functions).beams + this->Floats(beams);
  }
  std::size_t ExtinctionFirst(int channel) const { return this->sharedExtinction ? 0 : channel * this->Stride(); }

  std::vector<ChannelGroup> Groups() const
  {
    return this->sharedExtinction ? std::vector<ChannelGroup>{ { 0, this->channels } }
                                  : std::vector<ChannelGroup>{ { 0, 1 }, { 1, 1 }, { 2, 1 } };
  }
};

/// Writes value(voxel, channel) to `values` in this layout with `channels` channels, zero in the padding. `value` is
/// called from several threads.
template <class Value>
void WritePlanar(const VolumeLayout& layout, int channels, const Value& value, float* values)
{
  const std::size_t voxels = layout.grid.VoxelCount(), stride = layout.Stride();
  for (int c = 0; c < channels; ++c)
  {
    InThreads(voxels, 16384, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
      {
        values[c * stride + i] = value(i, c);
      }
    });
    std::fill(values + c * stride + voxels, values + (c + 1) * stride, 0.0f);
  }
  std::fill_n(values + channels * stride, SweepPadding, 0.0f);
}

/// Like WritePlanar, into a new array.
template <class Value>
std::vector<float> Planar(const VolumeLayout& layout, int channels, const Value& value)
{
  std::vector<float> values = Zeros(layout.FloatsOf(channels));
  WritePlanar(layout, channels, value, values.data());
  return values;
}

/// Like WritePlanar, into a new device buffer; on a CPU device without a copy.
/// @param what  name of the quantity, see Buffer
template <class Value>
Buffer<float> PlanarOnDevice(
  Device& device, const VolumeLayout& layout, int channels, const Value& value, const char* what)
{
  Buffer<float> values(device, layout.FloatsOf(channels), what);
  values.WriteInPlace([&](float* to) { WritePlanar(layout, channels, value, to); });
  return values;
}

/// The voxels' values of a planar array times `scale`, interleaved: the `parts` values of a voxel (channels times
/// components) are adjacent.
std::vector<float> Interleaved(const VolumeLayout& layout, const Buffer<float>& planar, double scale);
}
