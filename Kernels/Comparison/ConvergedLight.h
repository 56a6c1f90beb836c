#pragma once

#include "Comparison/ComparedRun.h"

#include <string>
#include <vector>

namespace tyndall
{
/// The reference that other results are compared with.
struct ReferenceLight
{
  Grid grid; ///< the scene's grid, or one finer or coarser by integer factors; comparisons use the coarser of both
  int channels = 1;
  std::vector<float> fluence;       ///< W / length^2, `channels` per voxel; empty: unknown; NaN: unknown in this voxel
  std::vector<float> fluenceDirect; ///< uncollided part of the fluence
  std::string text;                 ///< description of the reference
};

/// Computes a reference. With a constant refractive index, depending on ComparedSettings::monteCarloReference: Monte
/// Carlo photons (PhotonReference.h), or a converged run of the best method, with 256 directions per face, two rays per
/// voxel edge and tolerance 1e-6 on the doubled grid; less of it if that would take more than `seconds`, by
/// NominalSeconds. With a varying index: photons, of uncollided light or of all light
/// (ComparedSettings::scattersReference).
/// @throws InvalidInput if photons are always asked for but cannot simulate this scene; what the monitor throws, if the
///   machine is far slower than NominalSeconds
ReferenceLight ConvergedLight(Device& device, const ComparedScene& scene, const ComparedSettings& settings,
  double seconds, const Monitor& monitor = {});
}
