#pragma once

#include "Medium/FilledBricks.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Which bricks of a medium's grid rays have to look into: those that are filled, and their neighbours, into which
/// values between voxel centres reach. Of the voxels of the others it is enough that they hold nothing.
struct SeenBricks
{
  std::array<int, 3> count = { 0, 0, 0 };
  std::vector<unsigned char> seen; ///< 1 or 0 of each, x fastest
  bool all = true;                 ///< are
};

/// @param everywhere  rays do not leap over empty bricks: all are seen
SeenBricks SeenBricksOf(const FilledBricks& filled, bool everywhere);
}
