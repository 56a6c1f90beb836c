#pragma once

#include "Lights/Lights.h"

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
}
