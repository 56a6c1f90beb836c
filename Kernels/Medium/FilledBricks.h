#pragma once

#include "Medium/BrickShared.h"
#include "Medium/Medium.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Bricks of BrickEdge^3 voxels, counted from the grid's lower corner (the last of an axis may stand out of the grid),
/// and which of them hold any medium: sigma_t or emission that is not zero.
///
/// Found in one pass over the medium's own arrays, on all cores. No mask of a reader's stands for it: that would be
/// wrong, and light lost, after any filter that changes the arrays, and a medium that comes from no file has none.
struct FilledBricks
{
  std::array<int, 3> count = { 0, 0, 0 }; ///< along each axis
  std::vector<unsigned char> filled;      ///< 1 or 0, x fastest
  std::size_t filledCount = 0;

  double FilledPart() const
  {
    return this->filled.empty() ? 0.0
                                : static_cast<double>(this->filledCount) / static_cast<double>(this->filled.size());
  }
};

FilledBricks FindFilledBricks(const Medium& medium);
}
