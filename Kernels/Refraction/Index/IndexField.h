#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Medium/Grid.h"

#include <vector>

namespace tyndall
{
/// @throws InvalidInput if the width of a filter, in voxels, is even or not from 1 to 65
void CheckFilterSize(int filterSize);

/// Smooths a refractive index with a Gaussian of `filterSize` voxels per edge and a standard deviation of a sixth of
/// that (Pfeuti 2009, section 3.1.2: 9 and 9/6), one axis after the other; beyond the grid, the values of its outermost
/// voxels are repeated. Where the index is constant within the filter's reach, it stays the same to the last bit.
///
/// @param filterSize  valid for CheckFilterSize; 1: no smoothing
/// @throws DeviceError  if a second array of the index does not fit the device
void SmoothIndex(Device& device, const Grid& grid, int filterSize, Buffer<float>& index);

/// Gradient of n, 1/length, x fastest with three components per voxel: central differences, one-sided in the outermost
/// voxels. The device holds a few layers of the gradient at a time.
std::vector<float> IndexGradient(
  Device& device, const Grid& grid, const Buffer<float>& index, const Monitor& monitor = {});
}
