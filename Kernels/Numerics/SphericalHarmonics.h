#pragma once

#include <array>
#include <vector>

namespace tyndall
{
/// The real spherical harmonics of a direction, (degree + 1)^2 numbers: degree 0, 1, 2, ..., in each the orders
/// -l to l. Orthonormal: the integral of the product of two over all directions is 1 or 0.
std::vector<double> SphericalHarmonics(int degree, const std::array<double, 3>& omega);

/// The degree that the `term`th of them has, counted from 0.
int DegreeOfTerm(int term);
}
