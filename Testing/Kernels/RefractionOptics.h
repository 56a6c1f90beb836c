#pragma once

#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>

/// Geometrical optics of glass in air: what refraction at sharp faces does to a ray, and a smoothed border to a ball's
/// focus. Lengths of a ball are in its radii, angles in radians.
namespace optics
{
using tyndall::Pi;

/// How far a ball turns a ray that passes its centre, unbent, at a distance of `b`.
inline double BallTurn(double n, double b)
{
  return 2.0 * (std::asin(b) - std::asin(b / n));
}

/// How far behind the centre that ray meets the axis. b = 0: n / (2 (n - 1)), the focal distance of the ball lens.
inline double BallFocus(double n, double b)
{
  return b > 0.0 ? b / std::sin(BallTurn(n, b)) : 0.5 * n / (n - 1.0);
}

/// The focal distance, b = 0, of a ball whose index was smoothed by a Gaussian of standard deviation `width`. By
/// Bouguer's formula a ray that passes at b is turned by -2 b times the integral of n' / (n sqrt(n^2 r^2 - b^2)) dr.
inline double SmoothedBallFocus(double n, double width)
{
  const auto index = [&](double r) {
    const double scale = std::sqrt(2.0) * width;
    const double bell = std::exp(-std::pow((r - 1.0) / scale, 2)) - std::exp(-std::pow((r + 1.0) / scale, 2));
    const double inside = 0.5 * (std::erf((1.0 - r) / scale) + std::erf((1.0 + r) / scale));
    return 1.0 + (n - 1.0) * (inside - width / (std::sqrt(2.0 * Pi) * r) * bell);
  };
  const double from = std::max(1.0 - 8.0 * width, 1e-3), step = 0.01 * width;
  double power = 0.0;
  for (double r = from; r < 1.0 + 8.0 * width; r += step)
  {
    const double middle = index(r + 0.5 * step);
    power -= 2.0 * (index(r + step) - index(r)) / (middle * middle * (r + 0.5 * step));
  }
  return 1.0 / power;
}

/// How far a prism with the given angle at its apex turns a ray that comes in at `incidence` from its face's normal, on
/// the side of the apex's far side, through both faces. NaN where it is reflected totally.
inline double PrismTurn(double n, double apex, double incidence)
{
  const double inside = apex - std::asin(std::sin(incidence) / n);
  return incidence + std::asin(n * std::sin(inside)) - apex;
}

/// The incidence of least deviation: the ray is parallel to the base.
inline double IncidenceOfLeastTurn(double n, double apex)
{
  return std::asin(n * std::sin(0.5 * apex));
}
}
