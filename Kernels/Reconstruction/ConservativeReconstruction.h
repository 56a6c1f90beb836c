#pragma once

#include "Reconstruction/Reconstruction.h"

namespace tyndall
{
/// The mean light of all batches, with as much of each level's detail as they agree on (Estimator::Conservative).
/// Collective.
/// @param result  arrays of the box (Reconstruction::MakeRoom)
void ReconstructConservative(const Reconstruction& task, ReconstructedLight& result);
}
