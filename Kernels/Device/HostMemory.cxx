#include "Device/HostMemory.h"

#include "Device/Errors.h"
#include "Device/HostThreads.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <sys/mman.h>
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
    const auto whole = [](double number) { return std::to_string(static_cast<std::uint64_t>(std::min(number, 1e19))); };
    throw DeviceError(what + " needs " + whole(bytes) + " bytes; " + whole(usable) +
      " of this machine's memory can be used. " + advice);
  }
}

void TakePages(void* memory, std::size_t bytes)
{
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t page = LargePage;
  const std::uintptr_t begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page;
  const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
  if (end <= begin)
  {
    return;
  }
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE); // may fail, which only makes access slower
#ifdef MADV_POPULATE_WRITE
  InThreads((end - begin) / page, 16, [begin](std::size_t first, std::size_t last) {
    // may fail, which only makes access slower
    madvise(reinterpret_cast<void*>(begin + first * page), (last - first) * page, MADV_POPULATE_WRITE);
  });
#endif
#endif
}

void MakeZeros(std::vector<ZeroedArray> arrays)
{
  std::sort(arrays.begin(), arrays.end(), [](const ZeroedArray& a, const ZeroedArray& b) { return a.count > b.count; });
  for (const ZeroedArray& array : arrays)
  {
    *array.values = std::vector<float>(); // frees the old contents before the new ones are allocated
    *array.values = RoomFor(array.count);
  }
  std::atomic<std::size_t> next(0);
  InThreads(arrays.size(), 1, [&](std::size_t, std::size_t) {
    for (std::size_t i = next++; i < arrays.size(); i = next++)
    {
      arrays[i].values->resize(arrays[i].count);
    }
  });
}
}
