#pragma once

#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace tyndall
{
/// A range of layers in which beams are traced. Only periodic axes need more than the first pass.
struct Pass
{
  int begin, end;          ///< layers from the lamp
  bool onlyBefore = false; ///< beams are traced only up to `begin`

  Pass Next() const; ///< the following pass: it begins where this one ends and reaches four times as far
};

Pass FirstPass(const Grid& grid); ///< it reaches twice the box's longest edge

/// The beams of a lamp from one point, as rows. Space around the point is divided into six pyramids, one for each
/// direction along an axis. In each, beams lie on a grid of tangents that covers the visible part of the box that is
/// still inside it where the pass begins.
///
/// A beam is at most `width` voxels wide where it leaves the box or, in later passes, where the pass begins. Along
/// periodic axes, where in the end many beams cross every voxel, there are only as many as give each voxel several of
/// them (numerics.md, section 5.3).
///
/// @param position  of the point, voxels from the box's corner
/// @param reach  length to which beams are traced at most
std::vector<BeamRow> Beams(const Grid& grid, const std::array<bool, 3>& periodic, const Light& light,
  const glm::dvec3& position, double width, const Pass& pass, double reach);

/// Whether the beams of the first pass cover all of a spot's cone.
bool SeesAllOfCone(const Grid& grid, const Light& spot, const glm::dvec3& position);
}
