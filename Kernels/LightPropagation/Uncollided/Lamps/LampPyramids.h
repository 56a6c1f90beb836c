#pragma once

#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace tyndall
{
/// A part of the way of beams that go round a periodic axis. Others have the first only.
struct Pass
{
  int begin, end;          ///< layers from the lamp
  bool onlyBefore = false; ///< its beams stop where it begins

  Pass Next() const; ///< where this one ends, four times as far
};

Pass FirstPass(const Grid& grid); ///< twice the box's longest edge

/// The beams of a lamp from one point, row by row: in each of the six pyramids around it, one for each way along an
/// axis, a grid of tangents over what is seen of the box, and where the pass begins is still in it.
///
/// A beam is at most `width` voxels wide where it leaves the box or, in later passes, where the pass begins; along
/// periodic axes, where many beams come to every voxel in the end, as many as make some of them for each (numerics.md,
/// section 5.3).
///
/// @param position  of the point, voxels from the box's corner
/// @param reach  that they are followed to at most, a length
std::vector<BeamRow> Beams(const Grid& grid, const std::array<bool, 3>& periodic, const Light& light,
  const glm::dvec3& position, double width, const Pass& pass, double reach);

/// Whether the beams of the first pass hold all of a spot's cone.
bool SeesAllOfCone(const Grid& grid, const Light& spot, const glm::dvec3& position);
}
