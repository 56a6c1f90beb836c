#pragma once

#include "Device/Buffer.h"

namespace tyndall
{
/// Scratch that sweeps along different axes share: contents are undefined between sweeps.
struct SweepWorkspace
{
  Buffer<float> maps;    ///< the rays of an open axis
  Buffer<float> scratch; ///< planes being crossed
  Buffer<float> lost;    ///< what rounding takes from `path` in a sweep round a periodic axis

  /// Have room for so many floats. No sweep may be under way: what is too small is given back first.
  void Reserve(Device& device, std::size_t mapFloats, std::size_t scratchFloats);
  void ReserveLost(Device& device, std::size_t floats);
};
}
