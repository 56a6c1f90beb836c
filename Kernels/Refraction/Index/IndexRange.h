#pragma once

#include "Medium/Medium.h"

#include <cstdint>

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

/// Whether the index varies by more than rounding. Null values are 1 everywhere.
bool IndexVaries(const Field& ior, const Grid& grid);

/// @param levels  one octree level per voxel, or null
/// @throws InvalidInput if a level is above that of the single node that would hold the whole grid; names the first
///   such voxel
void CheckLevels(const std::uint8_t* levels, const Grid& grid);
/// The same check for the voxels of a part of a grid.
void CheckLevels(const std::uint8_t* levels, const Grid& part, const Grid& whole);
}
