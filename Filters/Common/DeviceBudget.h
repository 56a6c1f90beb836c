#ifndef DeviceBudget_h
#define DeviceBudget_h

#include "Device/Device.h"

#include <algorithm>
#include <memory>
#include <string>

/// MemoryBudget of filters.
namespace tyndall
{
/// @param mebibytes  0: no limit but the device's own
/// @param spills  what does not fit lies in host memory; false: it is an error
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

/// The device for a filter that keeps things on it, within its budget, beyond which is an error.
/// @param kept  the filter's own: what this gave last, given again where nothing has changed
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

#endif
