#pragma once

#include "LightPropagation/Diffusion/ExactValues.h"

#include <array>

namespace tyndall
{
/// Mixes an iteration's last three results so that it converges sooner and does not swing: Anderson's method with a
/// memory of two (D. G. Anderson, Iterative Procedures for Nonlinear Integral Equations, J. ACM 12, 1965). Given x and
/// what the iteration finds with it, the next x is the combination whose change is the least in the least squares.
class AndersonMixing
{
public:
  AndersonMixing(Device& device, std::size_t count, const char* what);

  /// How much a value counts in the change: tau / (1 + tau), tau = sigma_s length; of light in vacuum the source is
  /// nothing.
  struct Weighting
  {
    const Buffer<float>* sigma_s; ///< 1/length
    std::size_t first;            ///< where the values' begins
    float length;
  };

  /// @param given  what `found` was found with; becomes what to go on with
  /// @return |found - given| / |found|, weighted
  double Mix(const ExactValues& given, const ExactValues& found, const Weighting& weighting);

private:
  std::array<double, 2> Weights(
    const ExactValues& given, const ExactValues& found, const Weighting& weighting, double* change);

  Device& TheDevice;
  std::size_t Count;
  ExactValues Sums;
  std::array<Buffer<float>, 2> FoundBefore, ChangeBefore; ///< of the last mix and the one before
  int Mixes = 0;
};
}
