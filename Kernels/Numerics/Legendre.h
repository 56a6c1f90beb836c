#pragma once

#include <array>
#include <vector>

namespace tyndall
{
/// P_0(x) to P_degree(x), by recurrence, for |x| <= 1.
std::vector<double> LegendrePolynomials(int degree, double x);

/// sum_l scale[l] factors[l][k] P_l(x[k]) for all k at once, so that compilers vectorise it; |x| <= 1.
/// @param factors  one row per element of `scale`, each at least as long as `x`
std::vector<double> LegendreSums(
  const std::vector<double>& x, const std::vector<double>& scale, const std::vector<std::vector<double>>& factors);

/// Points in (-1, 1) and weights whose sum is 2: exact for polynomials up to degree 2 count - 1.
struct GaussLegendre
{
  explicit GaussLegendre(int count);

  std::vector<double> points, weights;
};

/// The real spherical harmonics of a direction, (degree + 1)^2 values: for each degree l = 0, 1, 2, ... the orders -l
/// to l. Orthonormal over the unit sphere.
std::vector<double> SphericalHarmonics(int degree, const std::array<double, 3>& omega);

/// Degree of the harmonic with index `term`, counted from 0.
int DegreeOfTerm(int term);
}
