#pragma once

#include "LightPropagation/Angular/AngularBasis.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Angular functions along the directions that rays go along: what a sweep turns moments of a source into its
/// directions with, and gathers moments with.
struct AngularValues
{
  int degree = 0;
  std::vector<std::vector<double>> functions; ///< [direction][function], as AngularBasis has them
  /// Angular distributions of further sources, which have no parity: [direction][beam].
  std::vector<std::vector<double>> beams;

  int Functions() const { return (this->degree + 1) * (this->degree + 1); }
  int Beams() const { return this->beams.empty() ? 0 : static_cast<int>(this->beams.front().size()); }
};

/// Angular functions by their parity along u and v, the axes across one that rays march along: even and even, odd and
/// even, even and odd, odd and odd.
struct FunctionOrder
{
  FunctionOrder(int degree, int u, int v);

  std::vector<int> functions;
  std::array<int, 4> counts = {};
};
}
