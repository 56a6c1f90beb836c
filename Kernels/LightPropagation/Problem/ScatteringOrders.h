#pragma once

#include "LightPropagation/Problem/PropagationProblem.h"

namespace tyndall
{
/// Scattering orders until next to nothing is left, about. In a slab of optical thickness tau orders fall off like
/// albedo (1 - pi^2 / (3 (tau + 1.42)^2)) (diffusion, extrapolated); the longest lines of voxels stand for the slab.
double OrdersNeeded(const PropagationProblem& problem);

/// So many that adding them up one by one is dearer than acceleration.
bool ScatteredManyTimes(const PropagationProblem& problem);

/// Whether light is to be carried far by a diffusion system between sweeps.
bool ToBeAccelerated(const PropagationProblem& problem);
}
