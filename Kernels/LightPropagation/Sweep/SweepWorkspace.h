#pragma once

#include "Device/Buffer.h"

#include <array>

namespace tyndall
{
/// Arrays of a streamed volume.
enum class SlotArray
{
  SigmaT,
  Source,
  Path,
  Lost,
  Flux,
  PartialCurrents,
  OctantSource,
  Count
};
using SlotSizes = std::array<std::size_t, static_cast<std::size_t>(SlotArray::Count)>;

/// Makes `buffer` hold at least `floats` floats, in device memory while any is left. A buffer that is too small is
/// freed first, so no work that uses it may be in progress.
void ReserveOnDevice(Device& device, Buffer<float>& buffer, std::size_t floats, const char* what);

/// Scratch memory shared by sweeps along different axes. Contents are undefined between sweeps.
struct SweepWorkspace
{
  Buffer<float> maps;    ///< rays of an open (not periodic) axis
  Buffer<float> scratch; ///< planes being crossed
  Buffer<float> lost;    ///< rounding errors of `path` (compensated summation), in sweeps round a periodic axis
  std::array<Buffer<float>, SlotSizes().size()> slots; ///< slots of streamed volumes (SliceStream.h)

  /// Ensures these sizes. No sweep may be in progress: buffers that are too small are freed first.
  void Reserve(Device& device, std::size_t mapFloats, std::size_t scratchFloats);
  void ReserveLost(Device& device, std::size_t floats);
  void ReserveSlots(Device& device, const SlotSizes& floats);
};
}
