#pragma once

#include "LightPropagation/Angular/DirectionSet.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Functions of direction in which the light of a voxel is gathered and scattered: real spherical harmonics up to a
/// degree, made orthonormal on a set of directions (numerics.md, section 4.7). So the sums over the set that stand for
/// integrals are exact where it matters: what is scattered adds up to what there was, and its mean direction is the
/// mean cosine times that of what came, to rounding, on every set.
///
/// Function i of degree l has i from l^2 to (l + 1)^2 - 1; function 0 is 1, functions 1, 2, 3 are sqrt(3) times y, z,
/// x. Their squares average to 1 over all directions. Each is even or odd along each axis.
class AngularBasis
{
public:
  /// @param degree  L, at most MostDegree of the set
  AngularBasis(const DirectionSet& set, int degree);

  int Degree() const { return this->L; }
  int Count() const { return (this->L + 1) * (this->L + 1); }
  static int DegreeOf(int function); ///< l
  static int OrderOf(int function);  ///< m, from -l to l
  /// Whether a function changes its sign where x, y, z does.
  static std::array<bool, 3> IsOdd(int function);

  /// [function][harmonic]: the functions as sums of spherical harmonics whose squares average to 1.
  std::vector<double> Matrix() const;
  /// All functions in a direction, that of the set or any other. @param omega  a unit vector
  std::vector<double> At(const std::array<double, 3>& omega) const;

private:
  int L;
  /// Row i: function i as a sum of the spherical harmonics of its own parity, 0 to i.
  std::vector<std::vector<double>> Rows;
};

/// The largest degree, at most `wanted`, whose functions a set of directions tells apart well.
int MostDegree(const DirectionSet& set, int wanted);
}
