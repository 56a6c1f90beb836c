#pragma once

#include "Reconstruction/Reconstruction.h"

namespace tyndall
{
/// Light of one level for each voxel (the other estimators).
/// @param counts, weights  empty where there are none
void ReconstructByLevel(const Reconstruction& task, const HostMappedBuffer<float>& counts,
  const HostMappedBuffer<float>& weights, double weightStep, ReconstructedLight& result);
}
