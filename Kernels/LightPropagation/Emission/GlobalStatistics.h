#pragma once

#include "LightPropagation/Problem/PropagationProblem.h"

namespace tyndall
{
/// Whether a few bright voxels emit so much that a serial solve may follow their light along exact rays
/// (EmissionPeaks.h), which several ranks do not; where the voxels do not lie close to each other, or absorb what they
/// emit, it does not all the same. Collective.
bool MayHaveEmissionPeaks(const PropagationProblem& problem);
}
