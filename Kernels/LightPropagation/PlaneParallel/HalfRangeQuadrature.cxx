#include "LightPropagation/PlaneParallel/HalfRangeQuadrature.h"

#include "Numerics/Legendre.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
HalfRangeQuadrature::HalfRangeQuadrature(int count)
{
  const GaussLegendre rule(count);
  for (int i = 0; i < count; ++i)
  {
    const double root = 0.5 * (1.0 + rule.points[i]);
    this->cosines.push_back(root * root);
    this->weights.push_back(rule.weights[i] * root);
  }
}

std::vector<double> NormalisedLegendre(int degree, int order, double x)
{
  std::vector<double> p(degree + 1, 0.0);
  if (order > degree)
  {
    return p;
  }
  const double sine = std::sqrt(std::max(0.0, (1.0 - x) * (1.0 + x)));
  p[order] = 1.0;
  for (int i = 1; i <= order; ++i)
  {
    p[order] *= sine * std::sqrt((2.0 * i - 1.0) / (2.0 * i));
  }
  const double m = order;
  for (int l = order + 1; l <= degree; ++l)
  {
    const double two = l > order + 1 ? std::sqrt((l - 1.0 - m) * (l - 1.0 + m)) * p[l - 2] : 0.0;
    p[l] = ((2.0 * l - 1.0) * x * p[l - 1] - two) / std::sqrt((l - m) * (l + m));
  }
  return p;
}
}
