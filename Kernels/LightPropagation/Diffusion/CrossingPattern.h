#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Crossing pattern of a quadrature: power of the rays that cross a voxel face at uniform radiance, divided by its mean
/// over the grid (numerics.md, Eq. (65)). It differs slightly from 1, because rays repeat a pattern of moves that
/// crosses some faces more often than others. For faces perpendicular to an axis it is the sum of two table entries,
/// one for the voxel's index along each of the two other axes.
struct CrossingPattern
{
  std::vector<float> values;
  /// Index in `values` of the first entry of each table, [axis perpendicular to the face][first, second of the other
  /// two axes].
  std::array<int, 6> first = {};
};
CrossingPattern FindCrossingPattern(const Grid& grid, const DirectionSet& directions, int mapResolution,
  RayStarts starts, const std::array<bool, 3>& periodic);

/// Sum of w mu over the directions with cosine mu > 0 to `axis`.
double HalfRange(const DirectionSet& set, int axis);
/// The part of HalfRange() of the directions whose rays march along the axis `marching`. A direction whose rays march
/// along several axes contributes a fraction to each.
double HalfRange(const Grid& grid, const DirectionSet& set, int axis, int marching);
}
