#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Power of rays that cross the voxels' faces in the sweeps' repeated pattern, over its mean (numerics.md, Eq. (65)):
/// by axis of the face and plane along each other axis, two parts of one sum. About 1; 1 in the mean over planes.
struct CrossingPattern
{
  std::vector<float> values;
  std::array<int, 6> first = {}; ///< [axis][other axes in order]
};
CrossingPattern FindCrossingPattern(const Grid& grid, const DirectionSet& directions, int mapResolution,
  RayStarts starts, const std::array<bool, 3>& periodic);

/// Sum of w mu over the directions of positive cosine mu to `axis` that march along `marching`; those that march along
/// several axes count in parts.
double HalfRange(const Grid& grid, const DirectionSet& set, int axis, int marching);
}
