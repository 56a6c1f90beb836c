#pragma once

#include "Reconstruction/Reconstruction.h"

namespace tyndall
{
/// Computes the light of each voxel from one level of its pyramid (all estimators except the conservative one).
/// Collective.
/// @param ownWeights  mean photon weight of each voxel of the block, if the estimator needs it
/// @param result      its arrays must have the size of the box (Reconstruction::MakeRoom)
void ReconstructFromLevels(const Reconstruction& task, const float* ownWeights, ReconstructedLight& result);
}
