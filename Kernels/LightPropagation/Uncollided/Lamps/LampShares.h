#pragma once

#include "LightPropagation/Sweep/SweepTally.h"
#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"

#include <array>
#include <numeric>

namespace tyndall
{
/// Factors that convert LampShares to fractions of the lamp's power.
struct LampFactors
{
  /// For the power that enters, that the medium removes, and that escapes or is still in flight.
  double in, taken, out;
};

/// Power balance of a lamp's beams, as fractions of its power.
struct LampShares
{
  std::array<double, 6> in = {}, out = {}; ///< by face
  double onTheWay = 0.0;                   ///< still in flight around a periodic axis
  double shone = 0.0;                      ///< emitted into the directions that were traced

  double In() const { return std::accumulate(this->in.begin(), this->in.end(), 0.0); }
  double Out() const { return std::accumulate(this->out.begin(), this->out.end(), this->onTheWay); }

  /// @param sums  tallies of one row of beams, [LampRowSums]
  void Count(const BeamRow& row, const float* sums)
  {
    // by the marching direction, for light of a lamp inside the box crosses no face on its way in
    this->in[2 * row.axis + row.up] += sums[0];
    for (int face = 0; face < 6; ++face)
    {
      this->out[face] += sums[1 + face];
    }
    this->onTheWay += sums[7];
    // counts each part of the lamp once: parts of the finest level only
    this->shone += row.skipped > 0 || row.partFrom > 0.0f ? 0.0 : sums[8];
  }

  /// @param power  of the lamp, W, by channel; `channels` of these are used
  SweepTally Times(const Rgb& power, int channels, const LampFactors& factors) const
  {
    SweepTally tally;
    for (int c = 0; c < channels; ++c)
    {
      for (int face = 0; face < 6; ++face)
      {
        tally.in[face][c] = power[c] * factors.in * this->in[face];
        tally.out[face][c] = power[c] * factors.out * this->out[face];
      }
      tally.onTheWay[c] = power[c] * factors.out * this->onTheWay;
    }
    return tally;
  }
};
}
