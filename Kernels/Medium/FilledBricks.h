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
/// Found in one pass over the medium's own arrays, on all cores, together with what else every solver asks of all
/// voxels: a medium that is mostly empty costs little more than to read it once. No mask of a reader's stands for it:
/// that would be wrong, and light lost, after any filter that changes the arrays, and a medium that comes from no file
/// has none.
struct FilledBricks
{
  /// Of all values of sigma_a, sigma_s or emission, in all components.
  struct Values
  {
    float largest = 0.0f; ///< where they are `sound`
    bool sound = true;    ///< finite and not negative; also false where one is -0
  };

  std::array<int, 3> count = { 0, 0, 0 }; ///< along each axis
  std::vector<unsigned char> filled;      ///< 1 or 0, x fastest
  std::size_t filledCount = 0;
  Values absorption, scattering, emission;

  double FilledPart() const
  {
    return this->filled.empty() ? 0.0
                                : static_cast<double>(this->filledCount) / static_cast<double>(this->filled.size());
  }
  /// Of the bricks in a row of voxels along x: whether each is filled.
  const unsigned char* RowOf(int y, int z) const
  {
    const auto row = static_cast<std::size_t>(z / BrickEdge * this->count[1] + y / BrickEdge);
    return this->filled.data() + row * static_cast<std::size_t>(this->count[0]);
  }
};

FilledBricks FindFilledBricks(const Medium& medium);

/// Check(medium) and FindFilledBricks in the same pass.
/// @throws InvalidInput as Check(medium)
FilledBricks CheckedBricks(const Medium& medium);
}
