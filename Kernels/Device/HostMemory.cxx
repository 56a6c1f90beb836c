#include "HostMemory.h"

#include "Errors.h"

#include <cstdio>
#include <unistd.h>

namespace tyndall
{
std::size_t HostMemory()
{
  return static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGE_SIZE));
}

void RequireHostMemory(double bytes, const std::string& what, const std::string& advice)
{
  const double usable = 0.75 * static_cast<double>(HostMemory());
  if (bytes > usable)
  {
    char numbers[96];
    std::snprintf(
      numbers, sizeof(numbers), " needs %.0f bytes; %.0f of this machine's memory can be used. ", bytes, usable);
    throw DeviceError(what + numbers + advice);
  }
}
}
