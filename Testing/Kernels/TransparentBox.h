#pragma once

#include <algorithm>
#include <array>
#include <cmath>

/// Mean fluence of a transparent box that emits 1 W / (length^3 sr) everywhere: the integral over all directions of the
/// mean distance from its points to its surface. Of a direction that is the mean of the least of three numbers that are
/// spread evenly, length / |omega| of each axis at most.
/// @param lengths  of its edges; infinite: it has no end along that axis
inline double MeanFluenceOfTransparentBox(const std::array<double, 3>& lengths)
{
  constexpr int steps = 600;
  constexpr double pi = 3.14159265358979323846;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i)
  {
    for (int j = 0; j < steps; ++j)
    {
      const double z = (i + 0.5) / steps, turn = 0.5 * pi * (j + 0.5) / steps, across = std::sqrt(1.0 - z * z);
      const double a = across * std::cos(turn) / lengths[0], b = across * std::sin(turn) / lengths[1],
                   c = z / lengths[2];
      const double t = 1.0 / std::max({ a, b, c });
      sum +=
        t - (a + b + c) * t * t / 2.0 + (a * b + b * c + c * a) * t * t * t / 3.0 - a * b * c * t * t * t * t / 4.0;
    }
  }
  return 4.0 * pi * sum / (steps * steps);
}
