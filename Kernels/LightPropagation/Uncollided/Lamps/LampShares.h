#pragma once

#include "LightPropagation/Sweep/SweepTally.h"
#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"

#include <array>

namespace tyndall
{
/// What became of the light of a lamp's beams, parts of its power.
struct LampShares
{
  std::array<double, 6> in = {}, out = {}; ///< by face
  double onTheWay = 0.0;                   ///< round a periodic axis
  double shone = 0.0;                      ///< in the directions that were followed

  /// @param sums  LampRowSums of beams of one row
  void Count(const BeamRow& row, const float* sums)
  {
    this->in[2 * row.axis + row.up] += sums[0]; // by the way it shines: lamps inside pass no face
    for (int face = 0; face < 6; ++face)
    {
      this->out[face] += sums[1 + face];
    }
    this->onTheWay += sums[7];
    this->shone += row.skipped > 0 ? 0.0 : sums[8];
  }

  /// @param power  of the lamp, W; `channels` of it
  SweepTally Times(const Rgb& power, int channels, double factor) const
  {
    SweepTally tally;
    for (int c = 0; c < channels; ++c)
    {
      for (int face = 0; face < 6; ++face)
      {
        tally.in[face][c] = power[c] * factor * this->in[face];
        tally.out[face][c] = power[c] * factor * this->out[face];
      }
      tally.onTheWay[c] = power[c] * factor * this->onTheWay;
    }
    return tally;
  }
};
}
