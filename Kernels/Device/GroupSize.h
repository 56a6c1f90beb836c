#pragma once

#include "Device/Device.h"

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
}
