#include "Numerics/Legendre.h"

#include "Numerics/Constants.h"

#include <cmath>

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
