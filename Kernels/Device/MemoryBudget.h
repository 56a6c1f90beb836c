#pragma once

#include <cstddef>
#include <limits>

namespace tyndall
{
/// Limits for a solve's use of a device's memory.
struct MemoryBudget
{
  static constexpr std::size_t NoLimit = std::numeric_limits<std::size_t>::max();

  std::size_t bytes = NoLimit; ///< limit for all buffers on the device together
  /// Whether buffers that do not fit are placed in host memory, from which the device reads them; false: an error.
  bool spills = false;
  std::size_t hostFrom = NoLimit; ///< arrays of at least this many bytes are always placed in host memory and streamed
};

/// Where an array should be placed.
enum class Residence
{
  AsBudgetSays,
  Device ///< as long as there is room: what kernels work in all the time
};
}
