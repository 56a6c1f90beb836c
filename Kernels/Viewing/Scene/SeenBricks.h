#pragma once

#include "Medium/FilledBricks.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Which bricks of a medium's grid rays may look into: those that are filled and their neighbours, into which values
/// between voxel centres reach. Nothing need be known of the voxels of the others but of those beside.
struct SeenBricks
{
  enum Sight : unsigned char
  {
    Unseen = 0,
    Beside = 1, ///< next to a brick that rays look into
    Seen = 2
  };

  std::array<int, 3> count = { 0, 0, 0 };
  std::vector<unsigned char> sight; ///< a Sight of each, x fastest
  bool all = true;                  ///< none is Unseen
};

/// @param everywhere  rays do not leap over empty bricks: all are Seen
SeenBricks SeenBricksOf(const Medium& medium, bool everywhere);
}
