#pragma once

#include "Reconstruction/Reconstruction.h"

namespace tyndall
{
/// Light of each voxel from one level of its pyramid (the estimators other than the conservative one). Collective.
/// @param ownWeights  of photons in the block's voxels, where the estimator needs them
/// @param result      arrays of the box (Reconstruction::MakeRoom)
void ReconstructFromLevels(const Reconstruction& task, const float* ownWeights, ReconstructedLight& result);
}
