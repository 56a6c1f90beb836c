#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Power of the rays that cross each face of the voxels in the sweeps' repeating ray pattern, divided by its mean
/// (numerics.md, Eq. (65)). It is the sum of two parts: for each axis of the face, one part for the plane of voxels
/// along each of the other two axes. About 1; the mean over planes is 1.
struct CrossingPattern
{
  std::vector<float> values;
  std::array<int, 6> first = {}; ///< offset of each table in `values`, [axis][other axes in order]
};
CrossingPattern FindCrossingPattern(const Grid& grid, const DirectionSet& directions, int mapResolution,
  RayStarts starts, const std::array<bool, 3>& periodic);

/// Sum of w mu over the directions with positive cosine mu to `axis` that march along `marching`; a direction that
/// marches along several axes counts in part for each.
double HalfRange(const Grid& grid, const DirectionSet& set, int axis, int marching);
}
