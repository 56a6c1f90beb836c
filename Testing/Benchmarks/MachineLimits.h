#pragma once

#include "Device/Device.h"

namespace bench
{
/// What the device can do at most, as measured with kernels that do nothing else: the fastest of many short runs, so
/// that it is the machine's and not its other users'.
struct MachineLimits
{
  double multiplyAdds = 0.0; ///< 1/s: fused multiply-adds of floats, on all cores; twice that are flop/s
  double bytes = 0.0;        ///< 1/s: a[i] = b[i] + s c[i] counted as 12 bytes
};

/// @param largeArrays  three arrays of 256 MiB instead of 32 MiB: beyond any cache
MachineLimits MeasureLimits(tyndall::Device& device, bool largeArrays);
}
