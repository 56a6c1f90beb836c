#pragma once

#include "Medium/Medium.h"

#include <algorithm>
#include <array>
#include <vector>

namespace tyndall
{
/// A small bright part of what a medium emits.
struct EmissionPeak
{
  std::array<int, 3> first = {}; ///< lowest voxel of the box around it
  std::array<int, 3> size = {};  ///< of the box, voxels
  std::vector<float> emission;   ///< [channel of 3][voxel of the box, x fastest], W / (length^3 sr)

  double Width(const Grid& grid) const ///< longest edge of the box
  {
    return std::max(
      { this->size[0] * grid.spacing[0], this->size[1] * grid.spacing[1], this->size[2] * grid.spacing[2] });
  }
};

/// A medium's emission as two parts that add up to it: one for a coarse set of directions, and small bright peaks,
/// whose light through a void would be a handful of rays in such a set (ray effects).
struct SplitEmission
{
  std::vector<EmissionPeak> peaks; ///< at most 16
  std::vector<float> smooth;       ///< the rest, in the layout of the medium's emission; empty where there are no peaks

  /// The part without the peaks.
  Field Smooth(const Medium& medium) const
  {
    Field field = medium.emission;
    field.values = this->peaks.empty() ? field.values : this->smooth.data();
    return field;
  }
};

/// Looks for connected groups of voxels among the brightest 64th of all that outshine the mean of the others more than
/// fourfold; what is above that is a peak. Each has to carry at least a hundredth of the power, to be at most an eighth
/// of the box's longest edge wide, and to be seen: light that leaves it in the clearest of 26 directions must go
/// further than one and a half times its width before all but a hundredth has met the medium. No voxel of it may be
/// thicker than 30000 mean free paths. All peaks together have to carry half of the power; else (a cloud that shines, a
/// flame) there are none.
SplitEmission Split(const Medium& medium);
}
