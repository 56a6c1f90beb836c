#pragma once

#include "Device/Buffer.h"
#include "Medium/Grid.h"
#include "Numerics/PyramidLayout.h"

namespace tyndall
{
/// Pyramid of the smallest and largest value in 2x2x2, 4x4x4, ... voxels (Pfeuti 2009, section 3.1.3).
///
/// Level 0 is the grid itself and is not stored again. A grid whose size is not a power of two is treated as if its
/// last voxel were repeated, so that a level never claims a range wider than its voxels have.
class MinMaxPyramid
{
public:
  /// Queues the construction and returns before it is done.
  /// @param values  nx*ny*nz floats, x fastest; finite
  /// @throws DeviceError if the pyramid (two floats for each of PyramidLayout's nodes) does not fit the device
  MinMaxPyramid(Device& device, const Grid& grid, const Buffer<float>& values);

  const PyramidLayout& Layout() const { return this->TheLayout; }

  /// Smallest and largest value (.s[0] and .s[1]) of each node of the levels from 1 on.
  const Buffer<cl_float2>& Nodes() const { return this->TheNodes; }

private:
  PyramidLayout TheLayout;
  Buffer<cl_float2> TheNodes;
};
}
