#include "Measure.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace bench
{
namespace
{
constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

/// A row of /proc/self/status, bytes.
double StatusBytes(const std::string& name)
{
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
  {
    if (line.compare(0, name.size(), name) == 0)
    {
      return 1024.0 * std::atof(line.c_str() + name.size());
    }
  }
  return Unknown;
}
}

double WallSeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double Median(std::vector<double> values)
{
  if (values.empty())
  {
    return Unknown;
  }
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double LoadAverage()
{
  double load = Unknown;
  std::ifstream("/proc/loadavg") >> load;
  return load;
}

PeakMemory::PeakMemory()
{
#ifdef __GLIBC__
  malloc_trim(0);
#endif
  std::ofstream("/proc/self/clear_refs") << "5";
  this->AtStart = StatusBytes("VmRSS:");
}

double PeakMemory::Bytes() const
{
  return std::max(0.0, StatusBytes("VmHWM:") - this->AtStart);
}
}
