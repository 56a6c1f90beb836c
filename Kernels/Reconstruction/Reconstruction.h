#pragma once

#include "Reconstruction/ArrayRange.h"
#include "Reconstruction/PhotonReconstruction.h"

namespace tyndall
{
/// Light that was checked, and what reconstructs it.
struct Reconstruction
{
  Device& device;
  const NoisyLight& light;
  const ReconstructionSettings& settings;
  const Monitor& monitor;
  const HostMappedBuffer<float>& fluence;   ///< light.batchFluence for the conservative estimator, else light.fluence
  const HostMappedBuffer<float>& direction; ///< empty where there is none
  ArrayRange range;                         ///< of `fluence`
  int levels;                               ///< of the pyramid above the grid

  /// What the light, whose totals are now `total`, is to be scaled by in each channel; sets result.bias.
  std::array<float, 3> Conserve(const std::array<double, 3>& total, ReconstructedLight& result) const;
};
}
