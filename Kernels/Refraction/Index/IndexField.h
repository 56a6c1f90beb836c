#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "Medium/Medium.h"

#include <cstdint>
#include <vector>

namespace tyndall
{
/// Valid range of a refractive index. Squares of such values, and differences of squares, are representable in float.
constexpr double LeastIndex = 1e-6;
constexpr double LargestIndex = 1e6;

/// Checks the refractive index of this rank's block.
/// @throws InvalidInput if a value is not finite or not from LeastIndex to LargestIndex; names the first such voxel, in
///   the whole grid
void CheckIndex(const Field& ior, const Domain& domain);

/// Smallest and largest refractive index of a grid; 1 for null values.
struct IndexRange
{
  float least = 1.0f;
  float largest = 1.0f;

  bool Varies() const; ///< whether the smallest and the largest index differ by more than rounding
};
IndexRange IndexRangeOf(const Field& ior, const Grid& grid);

/// Checks octree levels.
/// @param levels  one octree level per voxel of `part`, or null: no octree
/// @throws InvalidInput if a level is higher than the level of a single node that holds the domain `whole`; names the
///   first such voxel
void CheckLevels(const std::uint8_t* levels, const Grid& part, const Grid& whole);

/// Checks the width of the smoothing filter.
/// @throws InvalidInput if the width, in voxels, is even or not from 1 to 65
void CheckFilterSize(int filterSize);

/// Smooths a refractive index by a Gaussian of `filterSize` voxels per edge with a standard deviation of filterSize / 6
/// (Pfeuti 2009, section 3.1.2: 9 and 9/6). The filter is applied along one axis at a time. Beyond the grid, the values
/// of its outermost voxels are repeated. Where the index is constant within the filter's reach, it is unchanged to the
/// last bit.
///
/// @param filterSize  width of the filter, valid for CheckFilterSize; 1: no smoothing
/// @throws DeviceError  if a second array of the index does not fit into the device's memory
void SmoothIndex(Device& device, const Grid& grid, int filterSize, Buffer<float>& index);

/// Gradient of n, 1/length, three components per voxel, x fastest: central differences, one-sided in the outermost
/// voxels. The device holds only some layers of the gradient at a time.
std::vector<float> IndexGradient(
  Device& device, const Grid& grid, const Buffer<float>& index, const Monitor& monitor = {});

/// Coefficients of the tricubic B-spline of n^2 (numerics.md, Eq. (88)), in the layout of SquaredIndex.cl: the grid
/// with two more coefficients at both ends of each axis.
/// @param ior  refractive index, one value per voxel
/// @throws DeviceError if the coefficients do not fit into the device's memory
Buffer<float> SquaredIndexCoefficients(Device& device, const Grid& grid, const Buffer<float>& ior);
}
