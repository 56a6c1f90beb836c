#pragma once

#include <array>
#include <vector>

namespace tyndall
{
/// A direction of propagation and the solid angle it stands for.
struct Direction
{
  std::array<double, 3> omega = { 0.0, 0.0, 1.0 }; ///< unit vector, the way the light travels
  double weight = 0.0;                             ///< sr; all weights of a set add up to 4 pi
};

/// `count` directions on a spiral from +z to -z, a golden section of a turn apart, all of weight 4 pi / count
/// (Fibonacci points; E. B. Saff, A. B. J. Kuijlaars, Math. Intelligencer 19 (1997)). Any number will do.
/// @param count  1 to 65536, else InvalidInput
std::vector<Direction> SpiralDirections(int count);

/// The same with those weights, as near as can be to even ones, that integrate 1, omega and omega omega exactly.
/// @param count  16 at least
std::vector<Direction> WeightedSpiralDirections(int count);
}
