#pragma once

#include "Light/CommonColour.h"
#include "Medium/FilledBricks.h"
#include "Medium/Medium.h"
#include "Medium/VoxelBox.h"

namespace tyndall
{
/// What a medium does not do, so that solvers can leave it out. Found in one scan of its arrays (some milliseconds for
/// 128^3 voxels), or, where it is known which bricks are filled, of those bricks, and only where there is colour.
struct MediumTraits
{
  bool absorbs = false;       ///< sigma_a is not zero everywhere
  bool scatters = false;      ///< sigma_s
  bool emits = false;         ///< emission
  bool isotropic = true;      ///< g is 0, or nothing scatters
  bool grey = true;           ///< sigma_a, sigma_s (to 2e-7) and the phase function are the same in all channels
  bool greyExtinction = true; ///< their sum is; always where `grey` is
  CommonColour emission;
  VoxelBox filled; ///< the smallest box outside of which there is no medium: neither sigma_t nor emission
};

/// @param similarity  sigma_s (1 - g) stands for sigma_s in sigma_t
MediumTraits TraitsOf(const Medium& medium, bool similarity = false);
MediumTraits TraitsOf(const Medium& medium, const FilledBricks& bricks, bool similarity = false);
}
