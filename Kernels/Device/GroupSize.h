#pragma once

#include "Device/Defines.h"
#include "Device/Device.h"

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
