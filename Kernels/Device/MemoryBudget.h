#pragma once

#include <cstddef>
#include <limits>

namespace tyndall
{
/// What a solve may take of a device's memory.
struct MemoryBudget
{
  static constexpr std::size_t NoLimit = std::numeric_limits<std::size_t>::max();

  std::size_t bytes = NoLimit; ///< on the device, of all its buffers together
  /// What does not fit lies in host memory, from which the device reads it; false: it is an error.
  bool spills = false;
  std::size_t hostFrom = NoLimit; ///< arrays of so many bytes and more lie in host memory anyhow: they are streamed
};

/// Where an array is to lie.
enum class Residence
{
  AsBudgetSays,
  Device ///< as long as there is room: what kernels work in all the time
};
}
