#pragma once

#include "Lights/Lights.h"

#include <array>
#include <functional>

namespace tyndall
{
/// Incident and escaped power of a sweep, W, by face (-x, +x, -y, +y, -z, +z) and channel.
struct SweepTally
{
  std::array<Rgb, 6> in = {};
  std::array<Rgb, 6> out = {};
  Rgb onTheWay = {}; ///< power of rays still under way round a periodic axis, in its maps
};

/// @param first  channel of `sum` that corresponds to channel 0 of `tally`
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

/// Incident radiance, W / (length^2 sr), in `direction` (an index into the direction set) at `face`. For parallel
/// beams: their irradiance, W / length^2, and `direction` is 0.
using SweepBoundary = std::function<Rgb(int direction, int face)>;

/// Channels of the group (VolumeLayout.h) that begins at `first`: all three if `first` is 0, else channel `first` moved
/// to 0.
inline Rgb OfGroup(const Rgb& rgb, int first)
{
  return first == 0 ? rgb : Rgb{ rgb[first], 0.0, 0.0 };
}
/// @param boundary  must outlive the result; may be empty
inline SweepBoundary OfGroup(const SweepBoundary& boundary, int first)
{
  return boundary && first > 0
    ? [&boundary, first](int direction, int face) { return OfGroup(boundary(direction, face), first); }
    : boundary;
}
}
