#pragma once

#include "PhaseFunction/PhaseFunction.h"

#include <vector>

namespace tyndall
{
/// Radiance that repeated forward scattering adds to the first scattering of a parallel beam (with the whole phase
/// function), where the solver treats a part of scattering as unscattered (numerics.md, Eq. (112c)). Values are per
/// steradian, per unit of beam irradiance and per optical length of scattering along the beam's path, tabulated by
/// scattering angle and that optical length. Negative near the beam: the light treated as unscattered is in fact spread
/// in angle.
///
/// The table has AureoleRows + 2 rows of AureoleColumns + 2 numbers, see ShadowRays.cl.
/// @param straightOn  fraction of scattering that is treated as unscattered
/// @param degree      degree of the moments that were solved for, used where straightOn is not a moment of the function
std::vector<float> AureoleTable(const PhaseFunction& function, double straightOn, int degree);
}
