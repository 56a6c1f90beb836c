#pragma once

#include "LightPropagation/Problem/PropagationProblem.h"

namespace tyndall
{
/// Scattering orders, as sweeps carry them, until 1e-4 is left, about: those of diffusion in a slab with extrapolated
/// borders (numerics.md, Eq. (86)); thick lines of voxels stand for the slab.
double OrdersNeeded(const PropagationProblem& problem);

/// So many that adding them up one by one is forecast to take longer than acceleration: both in orders, by what set-up,
/// sweeps and corrections were measured to take (`./run bench thick`).
bool ScatteredManyTimes(const PropagationProblem& problem);

/// Whether to solve with diffusion acceleration.
bool ToBeAccelerated(const PropagationProblem& problem);
}
