#pragma once

#include "LightPropagation/Angular/DirectionSet.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Angular basis in which the light of a voxel is expanded and scattered: real spherical harmonics up to a degree,
/// orthonormalised on a quadrature (numerics.md, section 4.7). With this basis, on every quadrature, sums over the
/// quadrature conserve scattered power to rounding, and the mean cosine of scattered light is that of the phase
/// function.
///
/// Functions of degree l have indices from l^2 to (l + 1)^2 - 1. Function 0 is 1; functions 1, 2, 3 are sqrt(3) times
/// y, z, x. The square of each function averages to 1 over all directions. Each function is even or odd along each
/// axis.
class AngularBasis
{
public:
  /// @param degree  highest degree L of the functions, at most MostDegree() of the quadrature
  AngularBasis(const DirectionSet& set, int degree);

  int Degree() const { return this->L; }
  int Count() const { return (this->L + 1) * (this->L + 1); }
  static int DegreeOf(int function); ///< degree l of a function
  static int OrderOf(int function);  ///< order m of a function, from -l to l
  /// Whether a function of the basis is odd in x, y, z.
  static std::array<bool, 3> IsOdd(int function);

  /// Coefficients of the functions in spherical harmonics, [function][harmonic]. The harmonics are normalised so that
  /// their squares average to 1 over all directions.
  std::vector<double> Matrix() const;
  /// Values of all functions of the basis in any direction, which need not belong to the quadrature.
  /// @param omega  unit vector
  std::vector<double> At(const std::array<double, 3>& omega) const;

private:
  int L;
  /// Row i: coefficients of function i in the spherical harmonics 0 to i of the same parity.
  std::vector<std::vector<double>> Rows;
};

/// Largest degree, at most `wanted`, up to which the functions of an AngularBasis are well-conditioned (linearly
/// independent) on the quadrature `set`.
int MostDegree(const DirectionSet& set, int wanted);

/// Values of angular functions in the directions of a sweep's rays. The sweep uses them to evaluate the source in each
/// direction from its moments, and to accumulate moments of the light.
struct AngularValues
{
  int degree = 0;
  std::vector<std::vector<double>> functions; ///< values of an AngularBasis, [direction][function]
  /// Angular distributions of the first-scattered light of beams, [direction][beam]; these have no parity.
  std::vector<std::vector<double>> beams;

  int Functions() const { return (this->degree + 1) * (this->degree + 1); }
  int Beams() const { return this->beams.empty() ? 0 : static_cast<int>(this->beams.front().size()); }
};

/// Indices of angular functions sorted by parity along u and v, the two axes normal to the marching axis: even-even,
/// odd-even, even-odd, odd-odd. `counts` is the number of functions of each parity.
struct FunctionOrder
{
  FunctionOrder(int degree, int u, int v);

  std::vector<int> functions;
  std::array<int, 4> counts = {};
};
}
