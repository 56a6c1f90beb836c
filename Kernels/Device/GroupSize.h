#pragma once

#include "Device/Defines.h"
#include "Device/Device.h"

#include <algorithm>
#include <cstddef>
#include <string>

namespace tyndall
{
/// Work-group size for work-items that each process much data, a row or more. CPU: 1, so that all threads get some.
/// GPU: the driver's choice, since groups of one would leave most lanes idle.
/// @param dimensions  dimensions of the range, 1 to 3
inline cl::NDRange GroupOfLargeItems(const Device& device, int dimensions = 1)
{
  return !device.IsCpu() ? cl::NullRange
    : dimensions == 1    ? cl::NDRange(1)
    : dimensions == 2    ? cl::NDRange(1, 1)
                         : cl::NDRange(1, 1, 1);
}

/// Runs a kernel over a range of work-items; over an empty range nothing.
inline void Launch(
  Device& device, const cl::Kernel& kernel, const cl::NDRange& items, const cl::NDRange& group = cl::NullRange)
{
  const std::size_t* sizes = items.get();
  if (std::find(sizes, sizes + items.dimensions(), 0) == sizes + items.dimensions())
  {
    device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, items, group);
  }
}

/// Work-items per group in sums by groups (Numerics/GroupSum.cl); 1 on a CPU.
inline int SummingGroup(const Device& device)
{
  return device.IsCpu() ? 1 : 128;
}

/// Compiler option that defines GROUP for kernels that sum by groups.
inline std::string SummingOption(const Device& device)
{
  return Define("GROUP", SummingGroup(device));
}

/// Runs a summing kernel with `groups` groups per channel.
inline void RunSummingGroups(Device& device, const cl::Kernel& kernel, std::size_t groups, std::size_t channels = 1)
{
  const auto items = static_cast<std::size_t>(SummingGroup(device));
  device.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(groups * items, channels), cl::NDRange(items, 1));
}
}
