#pragma once

#include "Medium/Grid.h"
#include "Viewing/Scene/Camera.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// A block of a domain that is decomposed over several ranks, each of which renders its own block.
///
/// Its arrays hold its own voxels and, towards neighbouring blocks, a layer of ghost cells: between the centres of two
/// voxels of different blocks, light is interpolated from both.
struct GridBlock
{
  Grid whole;
  std::array<int, 3> first = {};           ///< index in the whole grid of the arrays' first voxel
  std::array<int, 3> begin = {}, end = {}; ///< its own voxels, [begin, end) in indices of the whole grid
  bool showsBackgroundBeside = false;      ///< shows the background to rays that miss the domain; true for one block

  std::size_t OwnVoxels() const
  {
    return static_cast<std::size_t>(this->end[0] - this->begin[0]) * (this->end[1] - this->begin[1]) *
      (this->end[2] - this->begin[2]);
  }
};

/// Restricts values on the faces of the domain (BoxFaces.h) to a block; 0 on block faces inside the domain.
/// @param ofWhole     values of all face cells of the domain
/// @param components  values per cell
/// @param size        of the block's arrays, voxels
std::vector<float> FacesOfBlock(
  const std::vector<float>& ofWhole, int components, const GridBlock& block, const std::array<int, 3>& size);

/// Indices of the blocks, sorted from front to back: no camera ray crosses a block after one that is later in the list.
/// Blocks that occlude each other cyclically have no such order; those of a k-d partition never do.
std::vector<int> FrontToBack(const std::vector<GridBlock>& blocks, const Camera& camera);
}
