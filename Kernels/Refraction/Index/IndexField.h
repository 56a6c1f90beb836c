#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Medium/Medium.h"

#include <cstdint>
#include <vector>

namespace tyndall
{
/// Valid range of a refractive index: squares of such values, and their differences, stay well within the range of
/// float.
constexpr double LeastIndex = 1e-6;
constexpr double LargestIndex = 1e6;

/// @throws InvalidInput if the index is not finite or not from LeastIndex to LargestIndex; names the first such voxel
void CheckIndex(const Field& ior, const Grid& grid);

/// Least and largest refractive index; null values are 1 everywhere.
struct IndexRange
{
  float least = 1.0f;
  float largest = 1.0f;

  bool Varies() const; ///< whether they differ by more than rounding
};
IndexRange IndexRangeOf(const Field& ior, const Grid& grid);

/// @param levels  one octree level per voxel of a part of a grid, or null
/// @throws InvalidInput if a level is above that of the single node that would hold the whole grid; names the first
///   such voxel
void CheckLevels(const std::uint8_t* levels, const Grid& part, const Grid& whole);

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

/// Coefficients of the B-spline of n^2 through voxel centres, in the layout of SquaredIndex.cl: the grid with two more
/// at either end of each axis.
/// @param ior  refractive index, one per voxel
/// @throws DeviceError if they do not fit
Buffer<float> SquaredIndexCoefficients(Device& device, const Grid& grid, const Buffer<float>& ior);
}
