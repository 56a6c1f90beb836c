#pragma once

#include "LightPropagation/Angular/AngularBasis.h"
#include "PhaseFunction/DeltaM.h"

#include <vector>

namespace tyndall
{
/// First-collision source of a parallel beam along each direction of a quadrature, minus its truncated angular moments
/// in `basis`, normalised to scattered light with a mean of 1 over all directions (numerics.md, Eqs. (42b), (42c)).
/// Truncated moments of a forward peak are negative sideways; the phase function without its peak is not. The peak
/// removed is the part of the phase function above some level around the forward direction, with as much power as
/// delta-M treats as unscattered.
///
/// All moments of the result in `basis` are zero to rounding, so the moments of the scattered light do not change.
std::vector<double> BeyondMoments(const PhaseFunction& function, const DeltaM& truncated, const DirectionSet& set,
  const AngularBasis& basis, const std::array<double, 3>& beam);

/// The same if the moments are smoothed so that the source is nowhere negative (WithoutNegatives): the complete
/// first-collision source of the beam minus its smoothed moments. The source along each direction then follows the
/// phase function, with the mean cosine of the moments; its higher moments differ from theirs.
std::vector<double> BeyondSmoothMoments(const PhaseFunction& function, const DeltaM& truncated, const DirectionSet& set,
  const AngularBasis& basis, const std::array<double, 3>& beam);
}
