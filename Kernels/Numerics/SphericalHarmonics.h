#pragma once

#include <array>
#include <vector>

namespace tyndall
{
/// The real spherical harmonics of a direction, (degree + 1)^2 values: for each degree l = 0, 1, 2, ... the orders -l
/// to l. Orthonormal over the unit sphere.
std::vector<double> SphericalHarmonics(int degree, const std::array<double, 3>& omega);

/// Degree of the harmonic with index `term`, counted from 0.
int DegreeOfTerm(int term);
}
