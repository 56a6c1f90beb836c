#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Crossing pattern of a quadrature: the power that its rays carry through a voxel face at uniform radiance, divided by
/// the mean over all such faces (numerics.md, Eq. (65)). It differs slightly from 1, because rays repeat a pattern of
/// moves that crosses some faces more often than others. For faces perpendicular to an axis it is the sum of two table
/// entries, one for the voxel's index along each of the two other axes.
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
/// Contribution to HalfRange() of the directions whose rays march along the axis `marching`. A direction whose rays
/// march along several axes contributes a fraction to each.
double HalfRange(const Grid& grid, const DirectionSet& set, int axis, int marching);

/// Properties of a sweep from which the diffusion system predicts the powers that the sweep carries through faces if
/// the fluence is linear and the source constant in each voxel (numerics.md, section 7.2). Differences from these
/// powers are transport that diffusion does not describe.
struct SweepModel
{
  /// Half-range flux of the quadrature divided by 4 pi (DiffusionLayout::halfRange).
  double halfRange = 0.25;
  CrossingPattern pattern;                               ///< of the whole grid
  std::array<std::vector<FlatSourceNode>, 3> flatSource; ///< by axis
};

/// Model of sweeps along the rays of light propagation maps through the whole grid.
SweepModel ModelOfRays(const Grid& grid, const SweptDirections& directions, const std::array<bool, 3>& periodic);
}
