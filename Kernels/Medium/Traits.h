#pragma once

#include "Light/CommonColour.h"
#include "Medium/FilledBricks.h"
#include "Medium/Medium.h"
#include "Medium/VoxelBox.h"

namespace tyndall
{
/// Properties of a medium that let solvers skip work. Determined in one scan of its arrays (some milliseconds for 128^3
/// voxels), or, if the filled bricks are known, of these bricks only.
struct MediumTraits
{
  bool absorbs = false;       ///< sigma_a is not zero everywhere
  bool scatters = false;      ///< sigma_s is not zero everywhere
  bool emits = false;         ///< emission is not zero everywhere
  bool isotropic = true;      ///< g is 0 in all voxels that scatter
  bool grey = true;           ///< sigma_a, sigma_s (to 2e-7) and the phase function are the same in all channels
  bool greyExtinction = true; ///< sigma_a + sigma_s is the same in all channels; true if `grey` is
  CommonColour emission;
  VoxelBox filled; ///< smallest box that contains all voxels with extinction or emission
};

/// @param similarity  use sigma_s (1 - g) instead of sigma_s in sigma_t
MediumTraits TraitsOf(const Medium& medium, bool similarity = false);
MediumTraits TraitsOf(const Medium& medium, const FilledBricks& bricks, bool similarity = false);
}
