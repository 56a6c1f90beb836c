#pragma once

#include "Device/Buffer.h"

#include <cstddef>

namespace tyndall
{
/// First-collision sources of beams, stored in a source array after its angular moments. They are emitted once: not in
/// the sweep during which the beams were traced, but in the next one.
class BeamsInSource
{
public:
  /// @param source  must outlive this
  /// @param first, count  index range of the beams in the source array
  BeamsInSource(Device& device, Buffer<float>& source, std::size_t first, std::size_t count)
    : TheDevice(device)
    , Source(source)
    , First(first)
    , Count(count)
  {
  }

  /// Moves the sources of the beams out of the array. Call before the sweep of the same order.
  void Hold();
  /// Restores them for the next sweep; if already restored, sets them to 0. Call after each sweep.
  void GoOn();

private:
  Device& TheDevice;
  Buffer<float>& Source;
  std::size_t First, Count;
  Buffer<float> Held;
};
}
