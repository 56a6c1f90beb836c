#pragma once

#include "Lights/Rgb.h"
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
/// whose light such a set would carry along a few rays through a void (ray effects).
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

/// Connected groups of voxels among the brightest 64th that outshine the mean of the others more than fourfold: small
/// ones (an eighth of the box's longest edge), in clear surroundings, not opaque, that carry half of the power
/// together; else there are none (a cloud that shines, a flame). A dark stone that emits hardly more than it absorbs of
/// the light that comes in is none either: its light and its shadow, which the sweeps cast, are exact together where
/// both go along the same directions. The limits: numerics.md, section 5.6.
/// @param comesIn  mean radiance through the box's faces, W / (length^2 sr)
SplitEmission Split(const Medium& medium, const Rgb& comesIn = {});

// Of these limits, those that tell from how bright voxels are alone whether there may be peaks.
constexpr std::size_t EmissionBrightPart = 64; ///< one voxel in so many may be part of a peak
constexpr double EmissionOutshines = 4.0;      ///< times the mean of the rest
constexpr double EmissionPartOfAll = 0.5;      ///< that all peaks carry, at least

/// Mean of the channels.
double EmissionBrightness(const Field& emission, std::size_t voxel);
}
