#pragma once

#include "Medium/Grid.h"
#include "Viewing/Scene/Camera.h"

#include <array>
#include <cstddef>
#include <vector>

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

/// What belongs to a block of values on the faces of the whole (BoxFaces.h); 0 on the block's other faces.
/// @param ofWhole     values of each cell of its faces
/// @param components  values of a cell
/// @param size        voxels of the block's arrays
std::vector<float> FacesOfBlock(
  const std::vector<float>& ofWhole, int components, const GridBlock& block, const std::array<int, 3>& size);

/// The numbers of blocks of one grid, from front to back: no ray of the camera meets one of them after one that stands
/// later. Where blocks hide each other in a circle, which those of a tree of planes do not, that cannot be for all.
std::vector<int> FrontToBack(const std::vector<GridBlock>& blocks, const Camera& camera);
}
