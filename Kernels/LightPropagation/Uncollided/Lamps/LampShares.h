#pragma once

#include "LightPropagation/Sweep/SweepTally.h"
#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"

#include <array>
#include <numeric>

namespace tyndall
{
/// By what shares are multiplied to be parts of a lamp's power.
struct LampFactors
{
  double in, taken, out; ///< what enters, what the medium takes, what leaves or is still on its way
};

/// What became of the light of a lamp's beams, parts of its power.
struct LampShares
{
  std::array<double, 6> in = {}, out = {}; ///< by face
  double onTheWay = 0.0;                   ///< round a periodic axis
  double shone = 0.0;                      ///< in the directions that were followed

  double In() const { return std::accumulate(this->in.begin(), this->in.end(), 0.0); }
  double Out() const { return std::accumulate(this->out.begin(), this->out.end(), this->onTheWay); }

  /// @param sums  LampRowSums of beams of one row
  void Count(const BeamRow& row, const float* sums)
  {
    this->in[2 * row.axis + row.up] += sums[0]; // by the way it shines: lamps inside pass no face
    for (int face = 0; face < 6; ++face)
    {
      this->out[face] += sums[1 + face];
    }
    this->onTheWay += sums[7];
    this->shone += row.skipped > 0 || row.partFrom > 0.0f ? 0.0 : sums[8]; // the smallest parts make up the lamp
  }

  /// @param power  of the lamp, W; `channels` of it
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
