#pragma once

#include <array>
#include <vector>

namespace tyndall
{
/// Power of one channel through the cells of the box's faces, W / length^2, without uncollided light of lamps.
struct SurfacePowers
{
  std::vector<double> net;       ///< out less in, by cell (BoxFaces.h)
  std::array<double, 6> in = {}; ///< through each face, in the mean over its cells
  std::vector<double> back;      ///< that comes back through each cell of a face that reflects; empty: none does
  const float* lamps = nullptr;  ///< fluence that came straight from lamps, by voxel; null: there are none
  double halfRange = 0.25; ///< of the directions that bring it: `in` of even light is its radiance times 4 pi of this
};
}
