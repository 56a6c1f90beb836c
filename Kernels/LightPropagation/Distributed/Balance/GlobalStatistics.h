#pragma once

#include "Distribution/Communicator.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/PropagationSettings.h"
#include "LightPropagation/ThickVoxels/OctantSources.h"

namespace tyndall
{
// What the solver of the whole has for some scenes, told of those that are spread over ranks.

/// OctantSources::Count of the medium of all ranks. All call it, and are told the same.
OctantSources::Voxels CountThickVoxels(Communicator& communicator, const BlockScene& scene);
/// OctantSources::Matter of the whole medium, where orders are added up one by one. All call it, and are told the same.
bool OctantSourcesMatter(Communicator& communicator, const BlockScene& scene, const PropagationSettings& settings);

/// All ranks call this, and are told the same. Blocks do not do it:
/// whether a few bright voxels emit so much that the whole may follow their light along rays of their own
/// (EmissionPeaks.h); where they do not lie close to each other, or are hidden, it does not all the same.
bool MayHaveEmissionPeaks(
  Communicator& communicator, bool has, const BlockScene& scene, const PropagationSettings& settings);
}
