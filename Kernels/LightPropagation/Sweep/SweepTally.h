#pragma once

#include "Lights/Lights.h"

#include <array>
#include <functional>

namespace tyndall
{
/// Power that came in and went out in a sweep, W per channel and face -x, +x, -y, +y, -z, +z.
struct SweepTally
{
  std::array<Rgb, 6> in = {};
  std::array<Rgb, 6> out = {};
  Rgb onTheWay = {}; ///< left in the maps of a periodic axis
};

/// @param first  channel of the sum, that is the tally's first
inline void Add(SweepTally& sum, const SweepTally& tally, int first = 0)
{
  for (int c = 0; first + c < 3; ++c)
  {
    for (int face = 0; face < 6; ++face)
    {
      sum.in[face][first + c] += tally.in[face][c];
      sum.out[face][first + c] += tally.out[face][c];
    }
    sum.onTheWay[first + c] += tally.onTheWay[c];
  }
}

/// Radiance, W / (length^2 sr), of `direction` (an index into the direction set) that comes in through `face`; of
/// parallel beams their irradiance, and `direction` is 0.
using SweepBoundary = std::function<Rgb(int direction, int face)>;

/// Of three channels those of a group (VolumeLayout.h) that begins at `first`: all three, or that one alone.
inline Rgb OfGroup(const Rgb& rgb, int first)
{
  return first == 0 ? rgb : Rgb{ rgb[first], 0.0, 0.0 };
}
/// @param boundary  must stay; may be none
inline SweepBoundary OfGroup(const SweepBoundary& boundary, int first)
{
  return boundary && first > 0
    ? [&boundary, first](int direction, int face) { return OfGroup(boundary(direction, face), first); }
    : boundary;
}
}
