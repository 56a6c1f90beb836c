#pragma once

#include "Numerics/Direction.h"
#include "PhaseFunction/PhaseFunction.h"

#include <vector>

namespace tyndall
{
/// From what the terms of a separable phase function are made.
enum class PhaseFactorisation
{
  SingularValues,    ///< the matrix of the phase function on the directions (Gong et al., section 3.2)
  SphericalHarmonics ///< its Legendre moments, degree by degree
};

/// What the matrix holds for a pair of directions.
enum class PhaseSampling
{
  PointValues, ///< the phase function between them, as published
  CellMeans    ///< its mean over the cells of both, taken as caps of their solid angles (numerics.md, Eq. (D3))
};

struct SeparableSettings
{
  int terms = 25; ///< at most as many as there are directions
  PhaseFactorisation factorisation = PhaseFactorisation::SphericalHarmonics;
  PhaseSampling sampling = PhaseSampling::PointValues;
  /// Any number of terms scatters exactly the power there is, from four on with exactly the mean cosine; false: as
  /// published, where truncation and sampling change both.
  bool repaired = true;
  /// A part of the light goes straight on (delta-M: W. J. Wiscombe, J. Atmos. Sci. 34 (1977)); terms stand for the
  /// rest. Not where singular values are all there: nothing is beyond them.
  bool truncatesPeak = false;
};

/// How far N terms are from the whole matrix.
struct SeparableErrors
{
  double frobenius = 0.0;  ///< root of the sum of squares, weighted by solid angles, over that of the matrix
  double maximum = 0.0;    ///< largest difference, over the matrix' peak
  double rowSum = 0.0;     ///< largest difference from 1 of the power scattered from a direction
  double meanCosine = 0.0; ///< largest difference of it, over the directions, from that of the phase function
  double least = 0.0;      ///< smallest value, over the peak; negative where terms are too few
};

/// A phase function on a set of directions as a sum of N products (Z. Gong et al., Interactive rendering of multiple
/// scattering in participating media using separable phase functions; numerics.md, Eqs. (D1) to (D6)),
///
///   p(i, j) = peak [i = j] / w_i + (1 - peak) sum_k lambda_k u_k(i) u_k(j),    sum_i w_i u_k(i) u_l(i) = [k = l]
///
/// so that scattering takes 2 N multiplications a direction, not D.
///
/// By singular values, the terms with the largest ones come first; repaired, the four before them that carry power and
/// mean cosine. By spherical harmonics, made orthonormal on the set degree by degree (J. E. Morel, Nucl. Sci. Eng. 101
/// (1989)), terms go by degree: N = (L + 1)^2 is a whole number of them, other N prefer some axes. Terms of eigenvalue
/// zero are left out.
class SeparablePhaseFunction
{
public:
  /// @param directions  weights positive; repaired: they must integrate 1 and omega exactly
  /// @throws InvalidInput where there are no directions or more than 1024 by singular values, terms are not from 1 to
  /// as many as directions, or a weight is not positive
  SeparablePhaseFunction(const PhaseFunction& function, std::vector<Direction> directions, SeparableSettings settings);

  int Terms() const { return static_cast<int>(this->Eigenvalues.size()); } ///< that are kept, at most those asked for
  int DirectionCount() const { return static_cast<int>(this->Directions.size()); }
  const std::vector<Direction>& TheDirections() const { return this->Directions; }
  double Peak() const { return this->PeakPart; }                        ///< part that goes straight on
  double Eigenvalue(int term) const { return this->Eigenvalues[term]; } ///< lambda, in [-1, 1] where repaired
  double Factor(int direction, int term) const                          ///< u, 1/sqrt(sr)
  {
    return this->Factors[static_cast<std::size_t>(term) * this->Directions.size() + direction];
  }
  double Value(int i, int j) const; ///< 1/sr, without the peak: sum_k lambda_k u_k(i) u_k(j)

  /// Absolute eigenvalues of the matrix, largest first: its singular values. Of spherical harmonics those of its terms.
  const std::vector<double>& SingularValues() const { return this->Singular; }
  /// The matrix itself, 1/sr, [i][j], repaired where it is, peak and all.
  const std::vector<double>& Matrix() const { return this->Whole; }
  /// Of 1, 2, ... as many terms as are kept, against Matrix().
  std::vector<SeparableErrors> ErrorsByTerms() const;

private:
  std::vector<Direction> Directions;
  double MeanCosine;
  double PeakPart = 0.0;
  std::vector<double> Eigenvalues, Factors, Singular, Whole;
};

/// What theory says of `frobenius`: a phase function on the sphere has the eigenvalues chi_l, each 2 l + 1 times; the
/// root of what the sum of their squares has beyond the `terms` largest, over all (numerics.md, Eq. (D4)).
/// @param moments  of the phase function, to a degree beyond which they do not matter
double TheoreticalError(const std::vector<double>& moments, int terms);

/// The matrix of a phase function on directions, 1/sr, [i][j]; symmetric. Not repaired.
std::vector<double> PhaseMatrix(
  const PhaseFunction& function, const std::vector<Direction>& directions, PhaseSampling sampling);

/// Legendre moments, degree by degree, of the mean over a cap of `solidAngle` sr around each direction.
std::vector<double> CapMoments(double solidAngle, int degree);
}
