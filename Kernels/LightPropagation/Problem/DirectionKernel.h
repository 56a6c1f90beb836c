#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "PhaseFunction/DeltaM.h"

#include <vector>

namespace tyndall
{
/// Discrete phase function: the scattering between the directions of a quadrature that a series of angular moments
/// gives (numerics.md, section 2.3). For a truncated forward peak it is negative for some pairs of directions.
class DirectionKernel
{
public:
  /// @param degree  degree of the moments, at most MostDegree(set)
  DirectionKernel(const DirectionSet& set, int degree);

  /// Minimum of the phase function (mean 1) for scattering into any direction of the set, from any direction of the set
  /// or between them.
  /// @param moments  moments 0 to the degree, or fewer
  double Least(const std::vector<double>& moments) const;

private:
  int Degrees;
  std::vector<float> Parts; ///< [pair of directions][degree]: contribution of a moment of 1
};

/// Returns `truncated` unchanged if its phase function is nowhere negative on the quadrature. Otherwise multiplies
/// moments of degree l by exp(-s l (l + 1)), with the smallest s that removes negative values; the unscattered part is
/// adjusted so that the mean cosine is unchanged.
DeltaM WithoutNegatives(const DeltaM& truncated, const DirectionKernel& kernel);
}
