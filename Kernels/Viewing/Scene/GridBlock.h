#pragma once

#include "Medium/Grid.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// A block of a larger grid: one of several, in the memory of several ranks, that each see their part of a picture.
///
/// Its arrays hold its own voxels and, where it has neighbours, a layer of theirs: light between the centres of two
/// voxels of two blocks is interpolated from both.
struct GridBlock
{
  Grid whole;
  std::array<int, 3> first = {};           ///< voxel of the whole at which the arrays begin
  std::array<int, 3> begin = {}, end = {}; ///< its own voxels of the whole: from begin on, before end
  bool showsBackgroundBeside = false;      ///< to rays that miss the whole; one of the blocks does

  std::size_t OwnVoxels() const
  {
    return static_cast<std::size_t>(this->end[0] - this->begin[0]) * (this->end[1] - this->begin[1]) *
      (this->end[2] - this->begin[2]);
  }
};
}
