#pragma once

#include "LightPropagation/Problem/PropagationProblem.h"

namespace tyndall
{
/// Directions per cube face of the unscattered light of faces, sky and environment: the settings', or, where these
/// leave it open (-1), as many as make a solve about a quarter longer at most, by a forecast of its scattering orders:
/// 49, 64 or 100, where faces of the box shine unevenly, none reflects, and orders are added up one by one. Else 0, the
/// same as for scattered light: an even sky and a smooth environment are right along few directions, and so is the
/// light that is scattered many times.
int UncollidedDirectionsFor(const PropagationProblem& problem, bool accelerated);
}
