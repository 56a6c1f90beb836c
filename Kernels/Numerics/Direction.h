#pragma once

#include <array>
#include <vector>

namespace tyndall
{
/// A quadrature direction: a direction of propagation and its weight.
struct Direction
{
  std::array<double, 3> omega = { 0.0, 0.0, 1.0 }; ///< unit vector, direction of propagation
  double weight = 0.0;                             ///< sr; the weights of a quadrature add up to 4 pi
};

/// `count` directions on a spiral from +z to -z, a golden section of a turn apart, all of weight 4 pi / count
/// (Fibonacci points; E. B. Saff, A. B. J. Kuijlaars, Math. Intelligencer 19 (1997)).
/// @param count  1 to 65536, else InvalidInput
std::vector<Direction> SpiralDirections(int count);

/// The same directions with the weights closest to uniform that integrate 1, omega and omega omega exactly.
/// @param count  at least 16
std::vector<Direction> WeightedSpiralDirections(int count);
}
