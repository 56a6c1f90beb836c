#pragma once

#include "LightPropagation/Angular/AngularBasis.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Angular functions in the directions of the rays. A sweep uses them to evaluate a source's moments in its directions,
/// and to accumulate moments of the light.
struct AngularValues
{
  int degree = 0;
  std::vector<std::vector<double>> functions; ///< [direction][function], see AngularBasis
  /// [direction][beam]: angular distributions of further sources (beams), which have no parity.
  std::vector<std::vector<double>> beams;

  int Functions() const { return (this->degree + 1) * (this->degree + 1); }
  int Beams() const { return this->beams.empty() ? 0 : static_cast<int>(this->beams.front().size()); }
};

/// Angular functions sorted by parity along u and v, the axes across the marching axis: even-even, odd-even, even-odd,
/// odd-odd.
struct FunctionOrder
{
  FunctionOrder(int degree, int u, int v);

  std::vector<int> functions;
  std::array<int, 4> counts = {};
};
}
