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
/// Number of floats in the widest vector of any kernel.
constexpr std::size_t SweepPadding = 16;

/// Channels that share one sigma_t and are swept together: `count` channels from `first` on.
struct ChannelGroup
{
  int first = 0;
  int count = 1;
};

/// Memory layout of arrays over voxels on the device: [channel][voxel], x fastest, with Stride() floats per channel.
/// This is the number of voxels, rounded up to whole vectors; the padding is zero. Buffers are SweepPadding floats
/// longer, so that a full vector may be read from any position in them.
struct VolumeLayout
{
  Grid grid;
  int channels = 1;
  /// True: all channels have the same sigma_t; false: three channels, each with its own sigma_t
  bool sharedExtinction = true;

  std::size_t Stride() const { return (this->grid.VoxelCount() + SweepPadding - 1) / SweepPadding * SweepPadding; }
  /// Number of floats of one quantity in all channels, without the padding at the end
  std::size_t Values() const { return this->channels * this->Stride(); }
  /// Number of floats of an array with `parts` values per voxel and channel, including the padding at the end.
  std::size_t Floats(int parts = 1) const { return this->FloatsOf(parts * this->channels); }
  /// Number of floats of an array with `channelCount` values per voxel, including the padding at the end.
  std::size_t FloatsOf(int channelCount) const { return channelCount * this->Stride() + SweepPadding; }
  /// Memory layout of an array with the moments of `functions` angular functions.
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
  /// Channel of the value at index `at` of an array of angular moments; not valid for the values of beams at its end.
  int ChannelOf(const MomentPlaces& places, std::size_t at) const
  {
    const std::size_t ofRow = static_cast<std::size_t>(places.groups) * (places.functions - 1) * MomentGroup;
    return static_cast<int>(at < places.second ? at / this->Stride() : (at - places.second) / ofRow % this->channels);
  }
  /// Number of floats of an array with angular moments and beams, including the padding at the end.
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

/// Writes value(voxel, channel) to `values` in the layout [channel][voxel], and zero to the padding. `value` is called
/// from several threads.
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

/// Returns an array [channel][voxel] filled with value(voxel, channel), zero in the padding; see WritePlanar.
template <class Value>
std::vector<float> Planar(const VolumeLayout& layout, int channels, const Value& value)
{
  std::vector<float> values = Zeros(layout.FloatsOf(channels));
  WritePlanar(layout, channels, value, values.data());
  return values;
}

/// Returns a device buffer [channel][voxel] filled with value(voxel, channel), zero in the padding; written without a
/// copy on a CPU. See WritePlanar.
/// @param what  name of the quantity for error messages, see Buffer
template <class Value>
Buffer<float> PlanarOnDevice(
  Device& device, const VolumeLayout& layout, int channels, const Value& value, const char* what)
{
  Buffer<float> values(device, layout.FloatsOf(channels), what);
  values.WriteInPlace([&](float* to) { WritePlanar(layout, channels, value, to); });
  return values;
}

/// Values of a planar array ([channel][voxel]), multiplied by `scale` and reordered as [voxel][channel].
std::vector<float> Interleaved(const VolumeLayout& layout, const Buffer<float>& planar, double scale);
}
