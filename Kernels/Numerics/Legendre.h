#pragma once

#include <array>
#include <vector>

namespace tyndall
{
/// Legendre polynomials P_0(x) to P_degree(x), by recurrence, for |x| <= 1.
std::vector<double> LegendrePolynomials(int degree, double x);

/// Values of sum_l scale[l] factors[l][k] P_l(x[k]) for all k, with |x| <= 1. All k are computed together, so that
/// compilers vectorise the computation.
/// @param factors  one row per element of `scale`, each at least as long as `x`
std::vector<double> LegendreSums(
  const std::vector<double>& x, const std::vector<double>& scale, const std::vector<std::vector<double>>& factors);

/// Gauss-Legendre quadrature: points in (-1, 1) and weights whose sum is 2. Exact for polynomials up to degree
/// 2 count - 1.
struct GaussLegendre
{
  explicit GaussLegendre(int count);

  std::vector<double> points, weights;
};

/// Real spherical harmonics of a unit vector, (degree + 1)^2 values: for each degree l = 0, 1, 2, ... the orders -l to
/// l. Orthonormal over the unit sphere.
std::vector<double> SphericalHarmonics(int degree, const std::array<double, 3>& omega);

/// Degree of the spherical harmonic with index `term`, counted from 0.
int DegreeOfTerm(int term);
}
