#pragma once

namespace tyndall
{
/// tanh(x) / x; 1 at 0.
double TanhOver(double x);
/// (1 - tanh(x / 2) / (x / 2)) / x^2; 1/12 at 0. This is the mean over [0, 1] of the solution of a'' = x^2 a - 1 with a
/// = 0 at both ends.
double MeanOfEvenSource(double x);

/// Integrals of the solution of a'' = x^2 a - exp(-r s) on [0, 1] with a = 0 at both ends: a mode with decay rate x,
/// driven by a beam that is attenuated by exp(-r) across a layer. x, r >= 0.
struct BeamIntegrals
{
  BeamIntegrals(double x, double r);

  double slopeAtEntry; ///< a'(0)
  double slopeAtExit;  ///< -a'(1)
  double mean;         ///< of a
  double meanBeam;     ///< of exp(-r s)
};
}
