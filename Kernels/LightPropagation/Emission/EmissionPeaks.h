#pragma once

#include "LightPropagation/Problem/PropagationProblem.h"
#include "Lights/Rgb.h"
#include "Medium/Medium.h"

#include <algorithm>
#include <array>
#include <vector>

namespace tyndall
{
/// A small, bright emitting region of a medium: its bounding box and the emission in it.
struct EmissionPeak
{
  std::array<int, 3> first = {}; ///< lowest voxel of the bounding box
  std::array<int, 3> size = {};  ///< size of the bounding box, voxels
  std::vector<float> emission;   ///< emission in the bounding box, W / (length^3 sr), [channel of 3][voxel, x fastest]

  double Width(const Grid& grid) const ///< longest edge of the bounding box, in units of length
  {
    return std::max(
      { this->size[0] * grid.spacing[0], this->size[1] * grid.spacing[1], this->size[2] * grid.spacing[2] });
  }
};

/// A medium's emission as the sum of a smooth field, which a coarse quadrature can sweep, and localised peaks, whose
/// light such a quadrature would carry through vacuum along a few rays only (ray effects).
struct SplitEmission
{
  std::vector<EmissionPeak> peaks; ///< localised emission, at most 16 peaks
  /// Emission minus peaks, W / (length^3 sr), [voxel][component]; empty if there are no peaks
  std::vector<float> smooth;
  int components = 1; ///< components of `smooth`: 1, or 3 if the emission is coloured

  /// The medium's emission without the peaks, W / (length^3 sr).
  Field Smooth(const Medium& medium) const
  {
    return this->peaks.empty() ? medium.emission : Field{ this->smooth.data(), this->components };
  }
};

/// Finds localised emission: connected groups of voxels among the brightest 64th whose emission exceeds four times the
/// mean of the remaining voxels. Groups must be small (at most an eighth of the box's longest edge), in transparent
/// surroundings and not opaque, and together carry half of the power; otherwise there are no peaks (as in a luminous
/// cloud or a flame). A dark solid that emits hardly more than it absorbs of the incident light is no peak either: its
/// shadow is swept, and its emission must be swept along the same directions for both to be accurate together. Limits:
/// numerics.md, section 5.6.
/// @param comesIn  mean incident radiance at the domain's faces, W / (length^2 sr)
SplitEmission Split(const Medium& medium, const Rgb& comesIn = {});

/// Whether emission can be split into peaks and the rest: EmissionError is above 0, no axis is periodic (there would be
/// infinitely many images), and the domain is on one rank or has at most 2^24 voxels, because every rank traces the
/// peaks' rays through the whole domain.
bool HasExactEmission(const PropagationProblem& problem);
/// Splits the emission of a domain; `smooth` has the voxels of this rank's block. No peaks if HasExactEmission() is
/// false. Collective.
SplitEmission SplitOfDomain(const PropagationProblem& problem, const Rgb& comesIn);

// Limits that Split() and MayHaveEmissionPeaks() apply to the brightness of voxels.
constexpr std::size_t EmissionBrightPart = 64; ///< at most one voxel in 64 belongs to a peak
constexpr double EmissionOutshines = 4.0; ///< peaks exceed this multiple of the mean emission of the remaining voxels
constexpr double EmissionPartOfAll = 0.5; ///< minimum fraction of the emitted power that all peaks together carry

/// Emission of a voxel, averaged over the three channels.
double EmissionBrightness(const Field& emission, std::size_t voxel);

/// Whether a few bright voxels dominate the emission, so that Split() may find peaks. Necessary, not sufficient:
/// Split() also requires that the voxels lie close together and do not absorb their own emission. Collective.
bool MayHaveEmissionPeaks(const PropagationProblem& problem);
}
