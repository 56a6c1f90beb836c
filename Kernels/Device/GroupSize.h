#pragma once

#include "Device/Defines.h"
#include "Device/Device.h"

#include <string>

namespace tyndall
{
/// The work-group size for work-items that each do much alone, a row or more: on a CPU one, so that all its threads
/// have some; on a GPU the driver's choice, for groups of one would leave most of its lanes idle.
/// @param dimensions  of the range, 1 to 3
inline cl::NDRange GroupOfLargeItems(const Device& device, int dimensions = 1)
{
  return !device.IsCpu() ? cl::NullRange
    : dimensions == 1    ? cl::NDRange(1)
    : dimensions == 2    ? cl::NDRange(1, 1)
                         : cl::NDRange(1, 1, 1);
}

/// Work-items of a group that add up together (Numerics/GroupSum.cl), side by side in memory: on a CPU each for itself.
inline int SummingGroup(const Device& device)
{
  return device.IsCpu() ? 1 : 128;
}

/// GROUP, as kernels that sum up by groups are compiled with.
inline std::string SummingOption(const Device& device)
{
  return Define("GROUP", SummingGroup(device));
}

/// Runs so many groups, of each of several channels.
inline void RunSummingGroups(Device& device, const cl::Kernel& kernel, std::size_t groups, std::size_t channels = 1)
{
  const auto items = static_cast<std::size_t>(SummingGroup(device));
  device.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(groups * items, channels), cl::NDRange(items, 1));
}
}
