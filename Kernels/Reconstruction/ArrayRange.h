#pragma once

#include "Device/HostMappedBuffer.h"

#include <array>
#include <optional>

namespace tyndall
{
/// What an array over voxels holds.
struct ArrayRange
{
  std::optional<std::size_t> unfit; ///< the first value that is not a number or outside what was asked for
  float largest = 0.0f;             ///< magnitude
  std::array<double, 3> total = {}; ///< of each component; [0] only if there is one
};

/// @param values  those of `array` on the host, in which the first unfit one is looked for
ArrayRange RangeOf(Device& device, const HostMappedBuffer<float>& array, const float* values, std::size_t count,
  int components, float low, float high);
}
