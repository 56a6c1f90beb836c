#pragma once

#include "LightPropagation/Angular/AngularBasis.h"
#include "PhaseFunction/DeltaM.h"

#include <vector>

namespace tyndall
{
/// What is first scattered of a parallel beam along each direction of a set, beyond the angular moments of a basis, of
/// light that is scattered with a mean of 1 over all directions (numerics.md, Eqs. (42b), (42c)). The truncated moments
/// of a forward peak are negative sideways; the phase function without its peak is not. The peak is what of it lies
/// above a level forwards, as much as goes straight on.
///
/// All moments of the basis are zero, to rounding: those of what is scattered stay as they are.
std::vector<double> BeyondMoments(const PhaseFunction& function, const DeltaM& truncated, const DirectionSet& set,
  const AngularBasis& basis, const std::array<double, 3>& beam);

/// The same where moments are smoothed such that nothing is negative (WithoutNegatives): all that is scattered of the
/// beam, less what its moments are. So the source along each direction is that of the phase function, with the mean
/// cosine of the moments; higher ones are its own.
std::vector<double> BeyondSmoothMoments(const PhaseFunction& function, const DeltaM& truncated, const DirectionSet& set,
  const AngularBasis& basis, const std::array<double, 3>& beam);
}
