#pragma once

#include <vector>

namespace tyndall
{
/// P_0(x) to P_degree(x), by recurrence; |x| <= 1.
std::vector<double> LegendrePolynomials(int degree, double x);

/// Points in (-1, 1) and weights whose sum is 2: exact for polynomials up to degree 2 count - 1.
struct GaussLegendre
{
  explicit GaussLegendre(int count);

  std::vector<double> points, weights;
};
}
