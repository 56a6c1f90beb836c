#pragma once

#include "Reconstruction/Reconstruction.h"

namespace tyndall
{
/// Light of all batches, of each level's detail what they agree on (Estimator::Conservative). The result's arrays have
/// their sizes.
void ReconstructConservative(const Reconstruction& task, ReconstructedLight& result);
}
