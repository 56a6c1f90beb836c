#pragma once

#include "Medium/Medium.h"

#include <cstdint>

namespace tyndall
{
/// Of a refractive index: squares of these, and their differences, leave room in float.
constexpr double LeastIndex = 1e-6;
constexpr double LargestIndex = 1e6;

/// @throws InvalidInput where the index is not finite and positive, LeastIndex to LargestIndex, naming the first such
///   voxel
void CheckIndex(const Field& ior, const Grid& grid);

/// Least and largest index; null values are 1 everywhere.
struct IndexRange
{
  float least = 1.0f;
  float largest = 1.0f;

  bool Varies() const; ///< by more than rounding does
};
IndexRange IndexRangeOf(const Field& ior, const Grid& grid);

/// Whether the index varies by more than rounding does. Null values are 1 everywhere.
bool IndexVaries(const Field& ior, const Grid& grid);

/// @param levels  a voxel, or null
/// @throws InvalidInput where an octree level is above that of the one node that holds the grid, naming the first
/// such voxel
void CheckLevels(const std::uint8_t* levels, const Grid& grid);
/// The same of the voxels of a part of a grid.
void CheckLevels(const std::uint8_t* levels, const Grid& part, const Grid& whole);
}
