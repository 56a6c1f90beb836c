#pragma once

#include "Device/Buffer.h"

#include <array>

namespace tyndall
{
/// The arrays of a volume that is streamed.
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

/// Room for so many floats, on the device as long as there is some. What is too small is given back first: nothing that
/// uses it may be under way.
void ReserveOnDevice(Device& device, Buffer<float>& buffer, std::size_t floats, const char* what);

/// Scratch that sweeps along different axes share: contents are undefined between sweeps.
struct SweepWorkspace
{
  Buffer<float> maps;    ///< the rays of an open axis
  Buffer<float> scratch; ///< planes being crossed
  Buffer<float> lost;    ///< what rounding takes from `path` in a sweep round a periodic axis
  std::array<Buffer<float>, SlotSizes().size()> slots; ///< of volumes that are streamed (SliceStream.h)

  /// Have room for so many floats. No sweep may be under way: what is too small is given back first.
  void Reserve(Device& device, std::size_t mapFloats, std::size_t scratchFloats);
  void ReserveLost(Device& device, std::size_t floats);
  void ReserveSlots(Device& device, const SlotSizes& floats);
};
}
