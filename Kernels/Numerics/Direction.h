#pragma once

#include <array>
#include <vector>

namespace tyndall
{
/// A quadrature direction: a direction of propagation and its weight.
struct Direction
{
  std::array<double, 3> omega = { 0.0, 0.0, 1.0 }; ///< unit vector, direction of propagation
  double weight = 0.0;                             ///< solid angle, sr; the weights of a quadrature add up to 4 pi
};

/// Quadrature of `count` directions on a spiral from +z to -z, at azimuths that differ by the golden angle, all of
/// weight 4 pi / count (Fibonacci points; E. B. Saff, A. B. J. Kuijlaars, Math. Intelligencer 19 (1997)).
/// @param count  1 to 65536, else InvalidInput
std::vector<Direction> SpiralDirections(int count);

/// Quadrature of SpiralDirections() with the weights closest to uniform that integrate 1, omega and omega omega
/// exactly.
/// @param count  16 to 65536, else InvalidInput
std::vector<Direction> WeightedSpiralDirections(int count);
}
