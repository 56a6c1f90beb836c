#pragma once

#include "Lights/Lights.h"

#include <cstddef>

namespace tyndall
{
/// The colour that several lights have in common, if they have one. Black has every colour.
class CommonColour
{
public:
  void Add(const Rgb& rgb);
  void AddNone() { this->One = false; }          ///< of something that changes colours
  void Add(const float* rgb, std::size_t count); ///< `count` colours, interleaved

  bool IsOne() const { return this->One; } ///< all are multiples of one, to rounding (3e-7, each component)
  bool IsGrey() const;                     ///< of white, exactly
  int Brightest() const;                   ///< the channel that has most
  Rgb Relative() const;                    ///< that colour, its brightest channel 1; white where all are black
  bool IsBlack() const { return this->Sum == Rgb{}; } ///< none of them shines

private:
  bool One = true;
  Rgb First = {}; ///< of those that are not black
  Rgb Sum = {};
};

/// The colour of all that shines from outside, and of the lights inside; none where a face gives back one colour more
/// than another.
CommonColour ColourOf(const Illumination& illumination);
}
