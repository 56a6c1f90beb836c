#include "Numerics/Legendre.h"

#include "Numerics/Constants.h"

#include <cmath>
#include <cstddef>
#include <utility>

namespace tyndall
{
std::vector<double> LegendrePolynomials(int degree, double x)
{
  std::vector<double> p(degree + 1, 1.0);
  if (degree > 0)
  {
    p[1] = x;
  }
  for (int l = 2; l <= degree; ++l)
  {
    p[l] = ((2 * l - 1) * x * p[l - 1] - (l - 1) * p[l - 2]) / l;
  }
  return p;
}

std::vector<double> LegendreSums(
  const std::vector<double>& x, const std::vector<double>& scale, const std::vector<std::vector<double>>& factors)
{
  const std::size_t count = x.size();
  std::vector<double> sums(count, 0.0), now(count, 1.0), before(count, 0.0);
  for (std::size_t l = 0; l < scale.size(); ++l)
  {
    if (l > 0)
    {
      const double up = (2.0 * l - 1.0) / l, down = (l - 1.0) / l;
      for (std::size_t k = 0; k < count; ++k)
      {
        before[k] = up * x[k] * now[k] - down * before[k];
      }
      std::swap(now, before);
    }
    const std::vector<double>& factor = factors[l];
    for (std::size_t k = 0; k < count; ++k)
    {
      sums[k] += scale[l] * factor[k] * now[k];
    }
  }
  return sums;
}

GaussLegendre::GaussLegendre(int count)
{
  for (int i = 0; i < count; ++i)
  {
    double x = -std::cos(Pi * (i + 0.75) / (count + 0.5));
    double slope = 1.0;
    for (int step = 0; step < 20; ++step) // each step of Newton's method doubles the number of correct digits
    {
      const std::vector<double> p = LegendrePolynomials(count, x);
      slope = count * (x * p[count] - p[count - 1]) / (x * x - 1.0);
      x -= p[count] / slope;
    }
    this->points.push_back(x);
    this->weights.push_back(2.0 / ((1.0 - x * x) * slope * slope));
  }
}

std::vector<double> SphericalHarmonics(int degree, const std::array<double, 3>& omega)
{
  std::vector<double> values((degree + 1) * (degree + 1));
  const double z = omega[2];
  // (x + i y)^m equals sin^m times the cosine (real part) and sine (imaginary part) of m times the azimuth. It needs no
  // special case at the poles.
  double real = 1.0, imaginary = 0.0;
  double sectoral = std::sqrt(1.0 / (4.0 * Pi)); // normalisation of the harmonic of degree m and order m, without sin^m
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
