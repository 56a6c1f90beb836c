#pragma once

#include <atomic>
#include <cstddef>
#include <limits>

namespace tyndall
{
/// Limits for a solve's use of a device's memory.
struct MemoryBudget
{
  static constexpr std::size_t NoLimit = std::numeric_limits<std::size_t>::max();

  std::size_t bytes = NoLimit; ///< limit for all buffers on the device together, bytes
  /// Whether buffers that do not fit are placed in host memory, from which the device reads them; false: DeviceError.
  bool spills = false;
  /// Arrays of at least this many bytes are always placed in host memory, and sweeps stream them to the device.
  std::size_t hostFrom = NoLimit;
};

/// Memory in which an array is placed.
enum class Residence
{
  AsBudgetSays,
  /// device memory as long as there is room, for arrays that kernels access all the time
  Device
};

/// Lock-free, thread-safe count of the bytes that are allocated out of a limit.
class MemoryCount
{
public:
  explicit MemoryCount(std::size_t limit)
    : Most(limit)
  {
  }

  std::size_t Limit() const { return this->Most; }
  std::size_t InUse() const { return this->Taken; }
  std::size_t Left() const { return this->Most - this->Taken; }
  std::size_t Peak() const { return this->Largest; } ///< largest number of bytes in use since ResetPeak()
  void ResetPeak() { this->Largest = this->InUse(); }

  /// Reserves bytes.
  /// @return whether enough bytes were left; if not, none are reserved
  bool Take(std::size_t bytes)
  {
    std::size_t before = this->Taken;
    do
    {
      if (bytes > this->Most - before)
      {
        return false;
      }
    } while (!this->Taken.compare_exchange_weak(before, before + bytes));
    for (std::size_t peak = this->Largest; peak < before + bytes;)
    {
      this->Largest.compare_exchange_weak(peak, before + bytes);
    }
    return true;
  }

  /// Releases bytes that were reserved by Take.
  void GiveBack(std::size_t bytes) { this->Taken -= bytes; }

private:
  const std::size_t Most;
  std::atomic<std::size_t> Taken{ 0 }, Largest{ 0 };
};
}
