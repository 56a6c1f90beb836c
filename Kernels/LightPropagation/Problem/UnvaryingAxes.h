#pragma once

#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

#include <array>

namespace tyndall
{
/// Periodic axes of one voxel, along which nothing varies. A scene with two of them is a plane-parallel slab.
class UnvaryingAxes
{
public:
  /// There are none if a lamp is inside or near the box, or if the source is constant as in the published scheme.
  UnvaryingAxes(const Grid& grid, const Illumination& illumination, const PropagationSettings& settings);

  bool IsSlab() const { return this->Single[0] + this->Single[1] + this->Single[2] == 2; }

  /// The grid with its voxels widened along these axes to ten times the edge along the other axes. Light does not
  /// depend on this width; with a smaller one rays would wrap around many times, with a larger one more sweeps are
  /// needed.
  Grid Widened(const Grid& grid) const;

private:
  std::array<bool, 3> Single = {};
};

/// Number of directions per cube face to solve with: that of the settings, with these exceptions:
///  - in a slab at least 144 (cheap, since mirror images are merged), with an even number of rows;
///  - with two periodic axes an even number of rows: with an odd number, some directions are parallel to the slab and
///    their
///    light never leaves (tau 0.01: reflectance 11% too low, 122 sweeps instead of 4).
/// No exceptions if the source is constant as in the published scheme, or if adaptDirections is false.
int DirectionsPerFaceFor(const PropagationSettings& settings, const UnvaryingAxes& unvarying);
}
