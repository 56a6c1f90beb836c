#pragma once

#include "Device/Device.h"
#include "Device/Sizes.h"
#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "Medium/Grid.h"

#include <array>

namespace tyndall
{
/// @param arrays  has the offsets of a channel and the stride (DiffusionSystem::Arrays, LampLight)
template <class Arrays>
DiffusionLayout LayoutOf(const Grid& grid, const std::array<bool, 3>& periodic, const Arrays& arrays)
{
  DiffusionLayout layout = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    layout.size[axis] = grid.size[axis];
    layout.periodic[axis] = periodic[axis];
    layout.spacing[axis] = static_cast<float>(grid.spacing[axis]);
  }
  layout.stride = static_cast<cl_int>(arrays.stride);
  layout.firstT = static_cast<cl_int>(arrays.firstT);
  layout.first = static_cast<cl_int>(arrays.first);
  return layout;
}

/// Runs a kernel with one work-item per voxel (VOXEL in DiffusionLayout.cl).
inline void RunVoxels(Device& device, cl::Kernel& kernel, const DiffusionLayout& layout)
{
  const cl::NDRange range(RoundUp<std::size_t>(layout.size[0], 32), RoundUp<std::size_t>(layout.size[1], 8),
    static_cast<std::size_t>(layout.size[2]));
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, range, cl::NDRange(32, 8, 1));
}
}
