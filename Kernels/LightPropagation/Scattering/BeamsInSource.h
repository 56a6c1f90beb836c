#pragma once

#include "Device/Buffer.h"

#include <cstddef>

namespace tyndall
{
/// What is first scattered of beams, in a source behind its angular moments. It shines once: not in the sweep beside
/// which the beams were found, but in the next one.
class BeamsInSource
{
public:
  /// @param source  must stay
  /// @param first, count  its values that are those of all beams
  BeamsInSource(Device& device, Buffer<float>& source, std::size_t first, std::size_t count)
    : TheDevice(device)
    , Source(source)
    , First(first)
    , Count(count)
  {
  }

  /// Before the sweep beside which they were found.
  void Hold();
  /// After a sweep: what was held is to shine in the next one, what was not has shone.
  void GoOn();

private:
  Device& TheDevice;
  Buffer<float>& Source;
  std::size_t First, Count;
  Buffer<float> Held;
};
}
