#pragma once

#include "LightPropagation/Angular/DirectionSet.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Angular basis in which the light of a voxel is expanded and scattered: real spherical harmonics up to a degree,
/// orthonormalised on a quadrature (numerics.md, section 4.7). Quadrature sums therefore conserve exactly, to rounding
/// and on every quadrature, the power that is scattered, and the mean direction of scattered light is the mean cosine
/// times that of the incident light.
///
/// Functions of degree l have indices from l^2 to (l + 1)^2 - 1. Function 0 is 1; functions 1, 2, 3 are sqrt(3) times
/// y, z, x. The square of each averages to 1 over all directions. Each is even or odd along each axis.
class AngularBasis
{
public:
  /// @param degree  L; at most MostDegree(set)
  AngularBasis(const DirectionSet& set, int degree);

  int Degree() const { return this->L; }
  int Count() const { return (this->L + 1) * (this->L + 1); }
  static int DegreeOf(int function); ///< l
  static int OrderOf(int function);  ///< m, from -l to l
  /// Whether a function is odd in x, y, z.
  static std::array<bool, 3> IsOdd(int function);

  /// [function][harmonic]: coefficients of the functions in spherical harmonics, normalised so that their squares
  /// average to 1.
  std::vector<double> Matrix() const;
  /// Values of all functions in any direction, of the set or not. @param omega  unit vector
  std::vector<double> At(const std::array<double, 3>& omega) const;

private:
  int L;
  /// Row i: coefficients of function i in the spherical harmonics 0 to i of the same parity.
  std::vector<std::vector<double>> Rows;
};

/// Largest degree, at most `wanted`, up to which the functions are well-conditioned (linearly independent) on the
/// quadrature.
int MostDegree(const DirectionSet& set, int wanted);

/// Angular functions in the directions of the rays. A sweep uses them to evaluate a source's moments in its directions,
/// and to accumulate moments of the light.
struct AngularValues
{
  int degree = 0;
  std::vector<std::vector<double>> functions; ///< [direction][function], see AngularBasis
  /// [direction][beam]: angular distributions of further sources (beams), which have no parity.
  std::vector<std::vector<double>> beams;

  int Functions() const { return (this->degree + 1) * (this->degree + 1); }
  int Beams() const { return this->beams.empty() ? 0 : static_cast<int>(this->beams.front().size()); }
};

/// Angular functions sorted by parity along u and v, the axes across the marching axis: even-even, odd-even, even-odd,
/// odd-odd.
struct FunctionOrder
{
  FunctionOrder(int degree, int u, int v);

  std::vector<int> functions;
  std::array<int, 4> counts = {};
};
}
