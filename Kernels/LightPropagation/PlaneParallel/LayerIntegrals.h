#pragma once

namespace tyndall
{
/// tanh(x) / x; 1 at 0.
double TanhOver(double x);
/// (1 - tanh(x / 2) / (x / 2)) / x^2: the mean over [0, 1] of what a'' = x^2 a - 1 gives that is 0 at both ends; 1/12
/// at 0.
double MeanOfEvenSource(double x);

/// Of a'' = x^2 a - exp(-r s) on [0, 1], 0 at both ends: the source of a beam that falls off by r across a layer, in a
/// mode that falls off by x. Both at least 0.
struct BeamIntegrals
{
  BeamIntegrals(double x, double r);

  double slopeAtEntry; ///< a'(0)
  double slopeAtExit;  ///< -a'(1)
  double mean;         ///< of a
  double meanBeam;     ///< of exp(-r s)
};
}
