#pragma once

#include "Lights/Lights.h"
#include "Medium/FilledBricks.h"
#include "Medium/Medium.h"
#include "Medium/VoxelBox.h"

#include <cstddef>

namespace tyndall
{
/// The common colour of several lights, if there is one. Black is a multiple of every colour.
class CommonColour
{
public:
  void Add(const Rgb& rgb);
  void AddNone() { this->One = false; }          ///< for something that changes the colour of light
  void Add(const float* rgb, std::size_t count); ///< `count` colours, interleaved

  bool IsOne() const
  {
    return this->One;
  }                      ///< whether all are multiples of one colour, to rounding (3e-7 per component)
  bool IsGrey() const;   ///< whether all are exact multiples of white
  int Brightest() const; ///< the channel with the largest sum
  Rgb Relative() const;  ///< the common colour, scaled so that its brightest channel is 1; white if all are black
  bool IsBlack() const { return this->Sum == Rgb{}; } ///< whether all are black

private:
  bool One = true;
  Rgb First = {}; ///< the first colour that is not black
  Rgb Sum = {};
};

/// The common colour of all boundary sources and of the lights inside the box; none if a face's albedo is coloured.
CommonColour ColourOf(const Illumination& illumination);

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
