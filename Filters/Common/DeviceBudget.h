#ifndef DeviceBudget_h
#define DeviceBudget_h

#include "Device/MemoryBudget.h"

namespace tyndall
{
/// Of a filter's MemoryBudget.
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
}

#endif
