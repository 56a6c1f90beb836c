#pragma once

#include "Medium/BrickShared.h"
#include "Medium/Medium.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Partition of a medium into bricks of BrickEdge^3 voxels. It records for each brick whether it is filled, i.e. has a
/// voxel with non-zero sigma_t or emission. Bricks begin at the grid's lower corner; the last one along an axis may
/// reach beyond the grid.
///
/// Determined in one pass over the medium's arrays, on all cores and together with the checks that every solver makes.
/// A mostly empty medium thus costs little more than one read. The active-voxel mask of a file is not used: after a
/// filter that changes the arrays it would be wrong and lose light, and a medium that was not read from a file has no
/// such mask.
struct FilledBricks
{
  /// Summary of all values of sigma_a, sigma_s or emission, in all components that channels use.
  struct Values
  {
    float largest = 0.0f; ///< largest value; valid only if `sound` is true
    bool sound = true;    ///< whether all values are finite and not negative; also false if any is -0
  };

  std::array<int, 3> count = { 0, 0, 0 }; ///< number of bricks along each axis
  std::vector<unsigned char> filled;      ///< by brick, x fastest: 1 if it is filled, else 0
  std::size_t filledCount = 0;
  Values absorption, scattering, emission;

  double FilledPart() const
  {
    return this->filled.empty() ? 0.0
                                : static_cast<double>(this->filledCount) / static_cast<double>(this->filled.size());
  }
  /// Part of `filled` for one row of bricks along x: the row that contains the voxels at (y, z).
  const unsigned char* RowOf(int y, int z) const
  {
    const auto row = static_cast<std::size_t>(z / BrickEdge * this->count[1] + y / BrickEdge);
    return this->filled.data() + row * static_cast<std::size_t>(this->count[0]);
  }
};

FilledBricks FindFilledBricks(const Medium& medium);

/// Checks a medium as Check(medium) does, and finds its filled bricks, in one pass.
/// @throws InvalidInput as Check(medium)
FilledBricks CheckedBricks(const Medium& medium);
}
