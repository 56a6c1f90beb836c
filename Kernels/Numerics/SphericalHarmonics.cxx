#include "Numerics/SphericalHarmonics.h"

#include "Numerics/Constants.h"

#include <cmath>

namespace tyndall
{
std::vector<double> SphericalHarmonics(int degree, const std::array<double, 3>& omega)
{
  std::vector<double> values((degree + 1) * (degree + 1));
  const double z = omega[2];
  // (x + i y)^m gives sin^m times cosine and sine of m times the azimuth, so that the poles need no special case.
  double real = 1.0, imaginary = 0.0;
  double sectoral = std::sqrt(1.0 / (4.0 * Pi)); // of order m in degree m, but sin^m
  for (int m = 0; m <= degree; ++m)
  {
    double last = 0.0, now = sectoral;
    for (int l = m; l <= degree; ++l)
    {
      const double scale = m == 0 ? 1.0 : std::sqrt(2.0);
      values[l * l + l + m] = scale * now * real;
      if (m > 0)
      {
        values[l * l + l - m] = scale * now * imaginary;
      }
      const double l1 = l + 1.0, square = l1 * l1 - m * m;
      const double a = std::sqrt((4.0 * l1 * l1 - 1.0) / square);
      const double b = std::sqrt((static_cast<double>(l) * l - m * m) / (4.0 * l * l - 1.0));
      const double next = a * (z * now - (l > m ? b * last : 0.0));
      last = now;
      now = next;
    }
    sectoral *= std::sqrt((2.0 * m + 3.0) / (2.0 * m + 2.0));
    const double turned = real * omega[0] - imaginary * omega[1];
    imaginary = real * omega[1] + imaginary * omega[0];
    real = turned;
  }
  return values;
}

int DegreeOfTerm(int term)
{
  int degree = 0;
  while ((degree + 1) * (degree + 1) <= term)
  {
    ++degree;
  }
  return degree;
}
}
