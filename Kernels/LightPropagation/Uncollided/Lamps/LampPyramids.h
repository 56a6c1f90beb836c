#pragma once

#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace tyndall
{
/// Range of layers of voxels in which beams are traced. Only periodic axes need more than the first pass.
struct Pass
{
  int begin, end;          ///< first and end layer, counted from the lamp
  bool onlyBefore = false; ///< whether beams are traced only up to `begin`

  Pass Next() const; ///< the following pass: begins where this pass ends, and reaches four times as far
};

Pass FirstPass(const Grid& grid); ///< the first pass reaches twice the box's longest edge

/// Beams of a lamp from one point, as rows. Space around the point is divided into six pyramids, one for each sense
/// along an axis. In each pyramid, beams form a grid of tangents. The grid covers the visible part of the box, in later
/// passes only rays that are still in the box where the pass begins.
///
/// A beam is at most `width` voxels wide where it leaves the box or, in later passes, where the pass begins. Along
/// periodic axes, where every beam crosses many voxels, the number of beams is only so large that several cross each
/// voxel (numerics.md, section 5.3).
///
/// @param position  position of the point, voxels from the box's corner
/// @param reach  maximum length to which beams are traced
std::vector<BeamRow> Beams(const Grid& grid, const std::array<bool, 3>& periodic, const Light& light,
  const glm::dvec3& position, double width, const Pass& pass, double reach);

/// Whether the beams of the first pass cover the whole cone of a spot.
bool SeesAllOfCone(const Grid& grid, const Light& spot, const glm::dvec3& position);
}
