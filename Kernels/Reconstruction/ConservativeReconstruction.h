#pragma once

#include "Reconstruction/Reconstruction.h"

namespace tyndall
{
/// Computes the mean light of all batches; the detail of each pyramid level is kept as far as the batches agree on it
/// (Estimator::Conservative). Collective.
/// @param result  its arrays must have the size of the box (Reconstruction::MakeRoom)
void ReconstructConservative(const Reconstruction& task, ReconstructedLight& result);
}
