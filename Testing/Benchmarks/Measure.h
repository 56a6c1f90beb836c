#pragma once

#include "Device/Clock.h"

#include <vector>

/// Clocks and memory of this process, for benchmarks on a machine that others may use too.
namespace bench
{
double WallSeconds(); ///< of a clock that never goes back
using tyndall::CoreSeconds;
double Median(std::vector<double> values);
double LoadAverage(); ///< of the last minute: processes that ran or wanted to; NaN where it is not known

/// The largest number of bytes in memory (VmHWM) above what there was at the start. Linux; NaN elsewhere.
class PeakMemory
{
public:
  PeakMemory(); ///< gives back what the process has freed, and forgets the peak so far
  double Bytes() const;

private:
  double AtStart;
};
}
