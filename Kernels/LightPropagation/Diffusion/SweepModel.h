#pragma once

#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Diffusion/CrossingPattern.h"
#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Properties of a sweep from which the diffusion system predicts the powers that the sweep carries through faces if
/// the fluence is linear and the source constant in each voxel (numerics.md, section 7.2). Differences from these
/// powers are transport that diffusion does not describe.
struct SweepModel
{
  /// Half-range flux of the quadrature over 4 pi (DiffusionLayout::halfRange).
  double halfRange = 0.25;
  CrossingPattern pattern;                               ///< of the whole grid
  std::array<std::vector<FlatSourceNode>, 3> flatSource; ///< by axis
};

/// Model of sweeps along the rays of light propagation maps through the whole grid.
SweepModel ModelOfRays(const Grid& grid, const SweptDirections& directions, const std::array<bool, 3>& periodic);
}
