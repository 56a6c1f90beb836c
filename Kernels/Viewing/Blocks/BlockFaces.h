#pragma once

#include "Viewing/Scene/GridBlock.h"

#include <array>
#include <vector>

namespace tyndall
{
/// What belongs to a block of values on the faces of the whole (BoxFaces.h); 0 on the block's other faces.
/// @param ofWhole     values of each cell of its faces
/// @param components  values of a cell
/// @param size        voxels of the block's arrays
std::vector<float> FacesOfBlock(
  const std::vector<float>& ofWhole, int components, const GridBlock& block, const std::array<int, 3>& size);
}
