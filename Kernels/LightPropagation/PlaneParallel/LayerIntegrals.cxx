#include "LightPropagation/PlaneParallel/LayerIntegrals.h"

#include <cmath>

namespace tyndall
{
namespace
{
constexpr double Thin =
  1e-3; ///< below it x^2 is neglected beside 1 in integrals of a beam, above it differences are used

/// (1 - exp(-r)) / r
double MeanOfExponential(double r)
{
  return r < 1e-8 ? 1.0 - 0.5 * r : -std::expm1(-r) / r;
}

/// Integral of exp(-x (1 - s) - r s) over [0, 1].
double MeanOfBoth(double x, double r)
{
  const double half = 0.5 * (x - r);
  if (std::abs(half) > 1.0)
  {
    return (std::exp(-r) - std::exp(-x)) / (x - r);
  }
  const double sinhOver = std::abs(half) < 1e-4 ? 1.0 + half * half / 6.0 : std::sinh(half) / half;
  return std::exp(-0.5 * (x + r)) * sinhOver;
}

/// Integral of s^power exp(-r s) over [0, 1] for r < 1, by its series.
double SeriesOfMoment(int power, double r)
{
  double term = 1.0, sum = 0.0;
  for (int n = 0; n < 20; ++n)
  {
    sum += term / (n + power + 1.0);
    term *= -r / (n + 1.0);
  }
  return sum;
}
}

double TanhOver(double x)
{
  return x < 1e-4 ? 1.0 - x * x / 3.0 : std::tanh(x) / x;
}

double MeanOfEvenSource(double x)
{
  return x < 0.02 ? (1.0 - 0.1 * x * x) / 12.0 : (1.0 - TanhOver(0.5 * x)) / (x * x);
}

BeamIntegrals::BeamIntegrals(double x, double r)
{
  this->meanBeam = MeanOfExponential(r);
  if (x < Thin)
  {
    const double first = r < 1.0 ? SeriesOfMoment(1, r) : (this->meanBeam - std::exp(-r)) / r;
    const double second = r < 1.0 ? SeriesOfMoment(2, r) : (2.0 * first - std::exp(-r)) / r;
    this->slopeAtEntry = this->meanBeam - first;
    this->slopeAtExit = first;
    this->mean = 0.5 * (first - second);
    return;
  }
  const double e = std::exp(-x), one = -std::expm1(-2.0 * x);
  const double along = MeanOfExponential(x + r), against = MeanOfBoth(x, r);
  this->slopeAtEntry = (along - e * against) / one;
  this->slopeAtExit = (against - e * along) / one;
  this->mean = (this->meanBeam - this->slopeAtEntry - this->slopeAtExit) / (x * x);
}
}
