#pragma once

#include "Numerics/Direction.h"
#include "PhaseFunction/PhaseFunction.h"

#include <vector>

namespace tyndall
{
/// Basis functions of a SeparablePhaseFunction.
enum class PhaseFactorisation
{
  SingularValues,    ///< singular vectors of the phase matrix on the directions (Gong et al., section 3.2)
  SphericalHarmonics ///< spherical harmonics; eigenvalues are Legendre moments of the phase function, degree by degree
};

/// How an element of the phase matrix, for a pair of directions, is computed.
enum class PhaseSampling
{
  PointValues, ///< value of the phase function at the angle between the two directions, as published
  /// Mean of the phase function over the cells of both directions; a cell is a cap with the direction's solid angle
  /// (numerics.md, Eq. (D3))
  CellMeans
};

/// Settings of a SeparablePhaseFunction.
struct SeparableSettings
{
  int terms = 25; ///< number of terms, at most the number of directions
  PhaseFactorisation factorisation = PhaseFactorisation::SphericalHarmonics;
  PhaseSampling sampling = PhaseSampling::PointValues;
  /// Whether to repair the truncated sum: it then conserves power exactly for any number of terms, and has the exact
  /// mean cosine if there are at least four terms. False: as published, where truncation and sampling change both power
  /// and mean cosine.
  bool repaired = true;
  /// Whether to treat a fraction of scattered light as unscattered (delta-M: W. J. Wiscombe, J. Atmos. Sci. 34 (1977));
  /// the terms represent the remainder. Ignored with singular values if all terms are kept, because the sum is then not
  /// truncated.
  bool truncatesPeak = false;
  /// Whether to damp the terms by their degrees until the sum is nowhere negative, as angular moments are damped in
  /// boxes that are thin along one axis (numerics.md, Eq. (8d)). Power and mean cosine are unchanged. Only with
  /// spherical harmonics.
  bool nowhereNegative = false;
};

/// Errors of the sum of N terms relative to the full phase matrix.
struct SeparableErrors
{
  double frobenius = 0.0; ///< relative Frobenius norm of sum minus full matrix, weighted by solid angles
  /// Largest absolute difference of an element of sum and full matrix, relative to the largest value of the matrix
  double maximum = 0.0;
  double rowSum = 0.0;     ///< largest deviation from 1 of the total power scattered from a direction
  double meanCosine = 0.0; ///< largest deviation of a direction's mean cosine from that of the phase function
  /// Smallest value of the sum, relative to the matrix' largest value; negative if there are too few terms.
  double least = 0.0;
};

/// A phase function on a set of directions as a sum of N products (Z. Gong et al., Interactive rendering of multiple
/// scattering in participating media using separable phase functions; numerics.md, Eqs. (D1) to (D6)),
///
///   p(i, j) = peak [i = j] / w_i + (1 - peak) sum_k lambda_k u_k(i) u_k(j),    sum_i w_i u_k(i) u_l(i) = [k = l]
///
/// Scattering then takes 2 N multiplications per direction; the full matrix takes as many as there are directions.
///
/// With singular values, the terms with the largest singular values come first; if repaired, the four terms that carry
/// power and mean cosine precede them. With spherical harmonics, orthonormalised on the directions degree by degree (J.
/// E. Morel, Nucl. Sci. Eng. 101 (1989)), terms are ordered by degree. N = (L + 1)^2 terms complete a degree; with any
/// other N some axes are preferred. Terms with eigenvalue zero are omitted.
class SeparablePhaseFunction
{
public:
  /// Factorises a phase function on a set of directions.
  /// @param directions  a quadrature with positive weights; if repaired, it must integrate 1 and omega exactly
  /// @throws InvalidInput if there are no directions, more than 1024 with singular values, the number of terms is not
  ///   from 1 to the number of directions, or a weight is not positive
  SeparablePhaseFunction(const PhaseFunction& function, std::vector<Direction> directions, SeparableSettings settings);

  int Terms() const
  {
    return static_cast<int>(this->Eigenvalues.size());
  } ///< number of terms kept, at most SeparableSettings::terms
  int DirectionCount() const { return static_cast<int>(this->Directions.size()); }
  const std::vector<Direction>& TheDirections() const { return this->Directions; }
  /// Fraction of scattered light treated as unscattered. It may be negative with SeparableSettings::nowhereNegative if
  /// the mean cosine is negative.
  double Peak() const { return this->PeakPart; }
  double Eigenvalue(int term) const { return this->Eigenvalues[term]; } ///< lambda_k of term k, in [-1, 1] if repaired
  double Factor(int direction, int term) const ///< value u_k(i) of a term k in direction i, 1/sqrt(sr)
  {
    return this->Factors[static_cast<std::size_t>(term) * this->Directions.size() + direction];
  }
  double Value(int i, int j) const; ///< sum_k lambda_k u_k(i) u_k(j), without the peak, 1/sr
  double LargestPower() const;      ///< largest sum over i of w_i Value(i, j): power scattered from a direction

  /// Absolute eigenvalues of the phase matrix (its singular values), largest first. With spherical harmonics: absolute
  /// eigenvalues of the terms.
  const std::vector<double>& SingularValues() const { return this->Singular; }
  /// The full phase matrix, 1/sr, [i][j], including the peak; repaired if the settings request it.
  const std::vector<double>& Matrix() const { return this->Whole; }
  /// Errors of the sums of 1, 2, ..., Terms() terms relative to Matrix().
  std::vector<SeparableErrors> ErrorsByTerms() const;

private:
  std::vector<Direction> Directions;
  double MeanCosine;
  double PeakPart = 0.0;
  std::vector<double> Eigenvalues, Factors, Singular, Whole;
};

/// Theoretical value of SeparableErrors::frobenius. A phase function on the sphere has its Legendre moments chi_l as
/// eigenvalues, each 2 l + 1 times. The error is the root of the sum of squares of all but the `terms` largest
/// eigenvalues, divided by the root of the sum over all eigenvalues (numerics.md, Eq. (D4)).
/// @param moments  Legendre moments of the phase function, up to a degree beyond which they are negligible
double TheoreticalError(const std::vector<double>& moments, int terms);

/// Phase matrix of a phase function on directions, 1/sr, [i][j]; symmetric, not repaired.
std::vector<double> PhaseMatrix(
  const PhaseFunction& function, const std::vector<Direction>& directions, PhaseSampling sampling);

/// Legendre moments, by degree, of the uniform distribution over a cap of `solidAngle` sr around a direction.
std::vector<double> CapMoments(double solidAngle, int degree);
}
