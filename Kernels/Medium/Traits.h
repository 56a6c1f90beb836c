#pragma once

#include "Lights/Lights.h"
#include "Medium/FilledBricks.h"
#include "Medium/Medium.h"
#include "Medium/VoxelBox.h"

#include <cstddef>

namespace tyndall
{
/// The colour that several lights have in common, if there is one. Black is a multiple of every colour.
class CommonColour
{
public:
  void Add(const Rgb& rgb);
  void AddNone() { this->One = false; }          ///< makes IsOne() false, for anything that changes the colour of light
  void Add(const float* rgb, std::size_t count); ///< adds `count` colours, RGB interleaved

  bool IsOne() const
  {
    return this->One;
  }                      ///< whether all colours are multiples of one colour, to rounding (3e-7 per component)
  bool IsGrey() const;   ///< whether all colours that were added are exact multiples of white
  int Brightest() const; ///< index of the brightest channel of the common colour
  Rgb Relative() const;  ///< the common colour, scaled so that its brightest channel is 1; white if all are black
  bool IsBlack() const { return this->Sum == Rgb{}; } ///< whether all colours that were added are black

private:
  bool One = true;
  Rgb First = {}; ///< first of the added colours that is not black; black if there is none
  Rgb Sum = {};
};

/// Common colour of all boundary sources and of the lights inside the box. If a face's albedo is coloured, there is no
/// common colour.
CommonColour ColourOf(const Illumination& illumination);

/// Properties of a medium that let solvers omit computations. Determined in one scan of its arrays (some milliseconds
/// for 128^3 voxels), or of its filled bricks only, if these are known.
struct MediumTraits
{
  bool absorbs = false;       ///< whether sigma_a is above zero in any voxel
  bool scatters = false;      ///< whether sigma_s is above zero in any voxel
  bool emits = false;         ///< whether emission is above zero in any voxel
  bool isotropic = true;      ///< whether g is 0 in all voxels that scatter
  bool grey = true;           ///< whether sigma_a, sigma_s (to 2e-7) and the phase function are equal in all channels
  bool greyExtinction = true; ///< whether sigma_a + sigma_s is equal in all channels; true if `grey` is
  CommonColour emission;
  VoxelBox filled; ///< smallest box that contains all voxels with extinction or emission
};

/// Determines the traits of a medium.
/// @param similarity  whether greyExtinction refers to sigma_a + sigma_s (1 - g)
MediumTraits TraitsOf(const Medium& medium, bool similarity = false);
MediumTraits TraitsOf(const Medium& medium, const FilledBricks& bricks, bool similarity = false);
}
