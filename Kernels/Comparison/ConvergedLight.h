#pragma once

#include "Comparison/ComparedRun.h"
#include "Device/Device.h"
#include "Device/Monitor.h"

#include <algorithm>
#include <string>
#include <vector>

namespace tyndall
{
/// Thrown by a monitor when a computation exceeds its time limit.
struct TimeIsUp
{
};

/// Monitor for the part of the work that covers the range [from, to] of all progress; throws TimeIsUp once the device's
/// clock is past `end`.
inline Monitor PartUntil(const Device& device, double end, const Monitor& monitor, double from, double to)
{
  return [=, &device](double done) {
    if (device.Now() > end)
    {
      throw TimeIsUp();
    }
    return !monitor || monitor(from + (to - from) * std::clamp(done, 0.0, 1.0));
  };
}

/// Nominal run times on two slow cores, seconds. These numbers decide how the reference is computed, so that the
/// decision does not depend on the machine's load. The clock is used only to stop work that takes too long.
struct NominalSeconds
{
  static constexpr double OfRayVoxel = 5e-9;   ///< time to sweep one ray through one voxel, per channel
  static constexpr double OfPhoton = 3e-6;     ///< time to emit one photon, without its path
  static constexpr double OfCrossing = 1e-7;   ///< time for one photon to cross one voxel
  static constexpr double OfScattering = 1e-6; ///< time to scatter one photon once
};

/// Reference light with which the results of all methods are compared.
struct ReferenceLight
{
  /// Grid of the reference: the scene's grid, or one that is finer or coarser by integer factors. Errors are computed
  /// on the coarser of the two grids.
  Grid grid;
  int channels = 1;
  /// Fluence, W / length^2, `channels` per voxel; empty: unknown; NaN: unknown in this voxel.
  std::vector<float> fluence;
  std::vector<float> fluenceDirect; ///< fluence of uncollided light, in the shape of `fluence`
  std::vector<float> radiance;      ///< picture of the fluence, 3 per pixel of the compared pictures; empty: unknown
  std::string text;                 ///< description of the reference for the user
};

/// Computes reference light. With a constant refractive index, ComparedSettings::monteCarloReference selects one of
/// two: Monte Carlo photons (PhotonReference.h), or a converged run of the best method. The converged run has 256
/// directions per face, two rays per voxel edge and tolerance 1e-6, on the grid with halved voxel edges. If it would
/// take more than `seconds` (NominalSeconds), it has fewer directions, rays or voxels. With a varying index, the
/// reference is uncollided light or all light from photons (ComparedSettings::scattersReference).
/// @throws InvalidInput if MonteCarloReference::Always is set but photons cannot simulate this scene; the exception of
///   the monitor, if the machine is far slower than NominalSeconds
ReferenceLight ConvergedLight(Device& device, const ComparedScene& scene, const ComparedSettings& settings,
  double seconds, const Monitor& monitor = {});
}
