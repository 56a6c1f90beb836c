#pragma once

#include <vector>

namespace tyndall
{
/// P_0(x) to P_degree(x), by recurrence; |x| <= 1.
std::vector<double> LegendrePolynomials(int degree, double x);

/// sum_l scale[l] factors[l][k] P_l(x[k]) of all x at once, which compilers turn into vectors; |x| <= 1.
/// @param factors  as many rows as `scale` has numbers, of at least as many as `x`
std::vector<double> LegendreSums(
  const std::vector<double>& x, const std::vector<double>& scale, const std::vector<std::vector<double>>& factors);

/// Points in (-1, 1) and weights whose sum is 2: exact for polynomials up to degree 2 count - 1.
struct GaussLegendre
{
  explicit GaussLegendre(int count);

  std::vector<double> points, weights;
};
}
