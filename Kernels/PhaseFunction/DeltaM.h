#pragma once

#include "PhaseFunction/PhaseFunction.h"

#include <vector>

namespace tyndall
{
/// A phase function whose forward peak is taken as light that goes straight on, the rest up to a degree (delta-M:
/// Wiscombe 1977; numerics.md, Eqs. (8a), (8b)). Scattering is then sigma_s (1 - forward), with the moments given here;
/// of degree 0 it is isotropic with sigma_s (1 - g), the similarity relation.
struct DeltaM
{
  double forward = 0.0;        ///< part of what is scattered that goes straight on; negative for degree 0 and g < 0
  std::vector<double> moments; ///< Legendre moments of the rest, 0 to degree: 1, ...

  DeltaM() = default;
  /// @param moments  of the phase function, one more than the degree has: to degree + 1
  explicit DeltaM(const std::vector<double>& moments);
};

/// Truncations of a phase function to the degrees 0 to `degree`.
std::vector<DeltaM> Truncations(const PhaseFunction& function, int degree);
}
