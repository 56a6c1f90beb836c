#pragma once

#include "Device/Device.h"

#include <algorithm>
#include <memory>
#include <string>

/// Limits of the memory that filters allocate on the host and on the OpenCL device.
namespace tyndall
{
/// Memory that this process can still allocate, bytes: the smallest of three limits, which are the machine's free or
/// reclaimable memory, the allowance of its container (cgroup 2) and its remaining address space (RLIMIT_AS). Infinity
/// if none of them is known.
double AvailableMemory();

// Converts the filters' property MemoryBudget to the kernels' MemoryBudget.
/// @param mebibytes  limit of device memory, MiB; 0: only the device's own limit
/// @param spills  true: data beyond the limit are kept in host memory; false: exceeding it is an error
inline MemoryBudget BudgetOf(int mebibytes, bool spills)
{
  MemoryBudget budget;
  if (mebibytes > 0)
  {
    budget.bytes = static_cast<std::size_t>(mebibytes) << 20;
    budget.spills = spills;
  }
  return budget;
}

/// Finds the OpenCL device `name` for a filter that keeps buffers on it between updates. The filter may use `mebibytes`
/// MiB of device memory (0: no limit); more is an error.
/// @param kept  member of the filter that caches the returned device; reused while name and budget are unchanged
inline std::shared_ptr<Device> FindWithin(std::shared_ptr<Device>& kept, const std::string& name, int mebibytes)
{
  struct Part
  {
    std::shared_ptr<Device> whole;
    Device within;
  };
  std::shared_ptr<Device> whole = Device::Find(name);
  if (mebibytes == 0)
  {
    kept.reset();
    return whole;
  }
  const MemoryBudget budget = BudgetOf(mebibytes, false);
  if (!kept || kept->Name() != whole->Name() || kept->MemoryLimit() != std::min(budget.bytes, whole->MemoryLimit()))
  {
    const std::shared_ptr<Part> part(new Part{ whole, { *whole, budget } });
    kept = std::shared_ptr<Device>(part, &part->within);
  }
  return kept;
}
}
