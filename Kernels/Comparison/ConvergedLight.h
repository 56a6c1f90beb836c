#pragma once

#include "Comparison/ComparedRun.h"

#include <string>
#include <vector>

namespace tyndall
{
/// The light that others are compared with.
struct ReferenceLight
{
  Grid grid; ///< the scene's, or one finer or coarser by whole factors: compared on the coarser of both
  int channels = 1;
  std::vector<float> fluence; ///< W / length^2, `channels` per voxel; empty: not known; NaN: not known in this voxel
  std::vector<float> fluenceDirect; ///< its unscattered part
  std::string text;                 ///< what it is
};

/// Where light goes straight, as ComparedSettings::monteCarloReference says: photons that are scattered until they end
/// (PhotonReference.h), or a converged run of the best method: 256 directions a face, two rays a voxel's edge,
/// tolerance 1e-6, on the doubled grid; less of it where that would take more than `seconds`, by NominalSeconds. Where
/// light is bent, photons: of unscattered light, or of all (ComparedSettings::scattersReference).
/// @throws InvalidInput where photons are asked for always, and cannot make the light of this scene; what the monitor
///         throws, where the machine is far slower
ReferenceLight ConvergedLight(Device& device, const ComparedScene& scene, const ComparedSettings& settings,
  double seconds, const Monitor& monitor = {});
}
