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
    for (int step = 0; step < 20; ++step) // Newton's method doubles the digits each time
    {
      const std::vector<double> p = LegendrePolynomials(count, x);
      slope = count * (x * p[count] - p[count - 1]) / (x * x - 1.0);
      x -= p[count] / slope;
    }
    this->points.push_back(x);
    this->weights.push_back(2.0 / ((1.0 - x * x) * slope * slope));
  }
}
}
