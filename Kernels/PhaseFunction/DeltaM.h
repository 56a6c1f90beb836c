#pragma once

#include "PhaseFunction/PhaseFunction.h"

#include <vector>

namespace tyndall
{
/// Delta-M truncation of a phase function (Wiscombe 1977; numerics.md, Eqs. (8a), (8b)): the forward peak is treated as
/// unscattered light, the rest is expanded up to a degree. Scattering is then sigma_s (1 - forward), with the moments
/// given here; for degree 0 it is isotropic with sigma_s (1 - g), the similarity relation.
struct DeltaM
{
  double forward = 0.0;        ///< fraction of scattered light treated as unscattered; negative for degree 0 and g < 0
  std::vector<double> moments; ///< Legendre moments 0 to degree of the rest; the first is 1

  DeltaM() = default;
  /// @param moments  Legendre moments 0 to degree + 1 of the phase function
  explicit DeltaM(const std::vector<double>& moments);
};

/// Truncations of a phase function to each of the degrees 0 to `degree`.
std::vector<DeltaM> Truncations(const PhaseFunction& function, int degree);
}
