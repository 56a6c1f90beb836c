#pragma once

#include "PhaseFunction/PhaseFunction.h"

#include <vector>

namespace tyndall
{
/// What a parallel beam's light that was scattered forwards several times adds to its first scattering by the whole
/// phase function, where a part of what is scattered was taken as light that goes straight on (numerics.md, Eq.
/// (112c)): per steradian, beam, and optical length of scattering that the beam has come through, by the scattering
/// angle and that length. Negative near the beam: the light that went straight on is there, but spread.
///
/// AureoleRows + 2 stretches of AureoleColumns + 2 numbers, see ShadowRays.cl.
/// @param straightOn  that part
/// @param degree      of the moments that are solved for, where straightOn is no moment of the function
std::vector<float> AureoleTable(const PhaseFunction& function, double straightOn, int degree);
}
