#include "Common/AvailableMemory.h"

#include <fstream>
#include <limits>
#include <sys/resource.h>
#include <unistd.h>

namespace tyndall
{
namespace
{
constexpr double Unknown = std::numeric_limits<double>::infinity();

/// Reads the number that follows `word` in a text file; Unknown if there is none.
double NumberAfter(const char* path, const std::string& word)
{
  std::ifstream file(path);
  for (std::string found; file >> found;)
  {
    double number = 0.0;
    if (found == word && file >> number)
    {
      return number;
    }
  }
  return Unknown;
}

/// Reads the number at the start of a text file; Unknown if the file starts with something else (such as "max").
double NumberInFile(const char* path)
{
  double number = 0.0;
  return std::ifstream(path) >> number ? number : Unknown;
}

double LeftInContainer()
{
  const double most = NumberInFile("/sys/fs/cgroup/memory.max"), taken = NumberInFile("/sys/fs/cgroup/memory.current");
  // File cache, bytes. memory.current includes the file cache, although the operating system frees it on demand.
  const double cache = NumberAfter("/sys/fs/cgroup/memory.stat", "inactive_file");
  return most == Unknown || taken == Unknown ? Unknown : most - taken + (cache == Unknown ? 0.0 : cache);
}

double LeftOfAddressSpace()
{
  struct rlimit limit = {};
  const double pages = NumberInFile("/proc/self/statm");
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || pages == Unknown)
  {
    return Unknown;
  }
  return static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}
}

double AvailableMemory()
{
  const double ofMachine = 1024.0 * NumberAfter("/proc/meminfo", "MemAvailable:");
  return std::max(0.0, std::min({ ofMachine, LeftInContainer(), LeftOfAddressSpace() }));
}
}
