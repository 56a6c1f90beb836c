#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "PhaseFunction/DeltaM.h"

#include <vector>

namespace tyndall
{
/// What angular moments scatter from one direction into another, as sweeps along a set of directions have it
/// (numerics.md, section 2.3): the moments of a forward peak make it negative here and there.
class DirectionKernel
{
public:
  /// @param degree  of the moments, at most MostDegree of the set
  DirectionKernel(const DirectionSet& set, int degree);

  /// The least that is scattered into any direction of the set, from any of it or from between them, the mean over all
  /// being 1.
  /// @param moments  0 to the degree, or fewer
  double Least(const std::vector<double>& moments) const;

private:
  int Degrees;
  std::vector<float> Parts; ///< [pair of directions][degree]: what a moment of 1 adds
};

/// The same truncation where nothing is negative, else one whose moments of degree l are smaller by exp(-s l (l + 1)),
/// with the least s of which nothing is. What goes straight on becomes such that the mean cosine stays.
DeltaM WithoutNegatives(const DeltaM& truncated, const DirectionKernel& kernel);
}
