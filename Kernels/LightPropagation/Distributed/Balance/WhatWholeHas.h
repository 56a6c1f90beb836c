#pragma once

#include "Distribution/Communicator.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/PropagationSettings.h"

namespace tyndall
{
// What the solver of the whole has for some scenes and that of blocks has not. All ranks call these, and are told the
// same.

/// OctantSources::Matter of the whole medium, where orders are added up one by one.
bool OctantSourcesMatter(Communicator& communicator, const BlockScene& scene, const PropagationSettings& settings);

/// Whether a few bright voxels emit so much that the whole may follow their light along rays of their own
/// (EmissionPeaks.h); where they do not lie close to each other, or are hidden, it does not all the same.
bool MayHaveEmissionPeaks(
  Communicator& communicator, bool has, const BlockScene& scene, const PropagationSettings& settings);
}
