#pragma once

#include "LightPropagation/Problem/PropagationProblem.h"

namespace tyndall
{
/// Whether a few bright voxels dominate the emission, so that a serial solve might trace their light along exact rays
/// (EmissionPeaks.h), which a solve on several ranks does not. Necessary, not sufficient: a serial solve also requires
/// that the voxels lie close together and do not absorb their own emission. Collective.
bool MayHaveEmissionPeaks(const PropagationProblem& problem);
}
