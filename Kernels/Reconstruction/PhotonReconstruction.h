#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"

#include <string>
#include <vector>

namespace tyndall
{
constexpr int ComparedBatchesAtMost = 16; ///< maximum number of batches for the conservative estimator

/// Light from a photon simulation, with its noise. Arrays have one entry per voxel of a rank's block, x fastest; null
/// if absent.
struct NoisyLight
{
  Grid grid;                            ///< grid of the arrays; Reconstruct uses the grid of its domain instead
  int channels = 1;                     ///< number of channels of the fluence: 1 or 3
  const float* fluence = nullptr;       ///< fluence, W / length^2; not read by the conservative estimator
  const float* meanDirection = nullptr; ///< mean direction of the light, 3 values per voxel, length at most 1; optional
  /// Number of photons that crossed each voxel; for the published and the nearest-photons estimator.
  const float* photonCount = nullptr;
  const float* photonWeight = nullptr; ///< mean Photon::weight of the counted photons; for the published estimator
  int batches = 1;                     ///< number of independent batches in batchFluence
  /// Fluence of each batch, W / length^2, [voxel][batch][channel]; its mean over batches is the fluence. For the
  /// conservative estimator, with 2 to ComparedBatchesAtMost batches.
  const float* batchFluence = nullptr;
};

struct ReconstructionSettings
{
  enum class Estimator
  {
    /// Takes the light of each voxel from the lower of two pyramid levels (Pfeuti 2009, section 3.2.4). One is the
    /// level up to which differences of successive levels do not grow; the other is proportional to the photon weight.
    Published,
    /// Keeps the detail of each pyramid level as far as independent batches agree on it, and estimates the error.
    Conservative,
    ConstantRadius, ///< light from the same pyramid level for all voxels (Pfeuti 2009, section 4.2)
    /// Light from the lowest pyramid level with at least `nearest` photons (Pfeuti 2009, section 4.2).
    NearestPhotons,
  };
  Estimator estimator = Estimator::Conservative;
  int levels = 5; ///< maximum number of pyramid levels above the grid, 1 to 8; limited by the grid's size
  /// Published: increment of photon weight from one level to the next; 0: 0.999 times the mean weight of voxels with
  /// photons.
  double weightStep = 0.0;
  int level = 1; ///< ConstantRadius: level of the pyramid from which light is taken, from 0
  /// NearestPhotons: minimum number of photons in a cell of the level from which light is taken, at least 1.
  int nearest = 20;
  /// Conservative: whether light of three channels with the same colour everywhere is smoothed once for all channels.
  bool leaveOut = true;
  bool conserve = true; ///< whether the light is scaled so that its total over the volume is unchanged
};

struct ReconstructedLight
{
  std::vector<float> fluence;       ///< W / length^2, with as many channels per voxel as the input, >= 0
  std::vector<float> meanDirection; ///< 3 values per voxel, length at most 1; empty if the input has none
  /// Pyramid level from which each voxel's light was taken; fractional where levels are blended.
  std::vector<float> mipLevel;
  /// Standard error of the fluence, W / length^2, `channels` values per voxel; empty unless the estimator is
  /// Conservative.
  std::vector<float> fluenceError;
  /// Relative change of the light's total over all channels by the reconstruction, before the light is scaled to
  /// conserve it.
  double bias = 0.0;
  std::vector<std::string> leftOut;
  std::string device;
};

/// Reduces the noise of photon light by pyramids. Lengths are in voxels (spacing does not matter); in grids of odd
/// size the last voxel is treated as if it were repeated.
///
/// Conservative (numerics.md, Eqs. (101) to (104)): builds a Laplacian pyramid of each batch (down by weights 1 3 3 1
/// along each axis, up by trilinear interpolation). Batches agree on light but not on noise. Their differences give a
/// Wiener gain for each level, which is the fraction of the level's detail that is kept. fluenceError covers the noise
/// that was kept and the light that was mistaken for noise. Negative light is set to 0. Mean directions are smoothed as
/// flux (fluence times direction) with the same gains. Light of three channels that has the same colour everywhere is
/// smoothed by the gains of the sum of channels, and its channels share one relative error; otherwise each channel is
/// smoothed separately and has its own error.
///
/// Published (Pfeuti 2009, section 3.2.4, listings B.2, B.3; numerics.md, Eq. (100)): uses the lower of two levels. One
/// is the level up to which the difference of successive levels does not grow. The other is the photon weight divided
/// by `weightStep`; the weight is taken from the first level that contains at least one photon. The published,
/// constant-radius and nearest-photons estimators interpolate light and directions trilinearly in a pyramid built with
/// a 4x4x4 Gaussian kernel.
///
/// Collective. Each rank stores its block with a halo of 32 voxels (16 for estimators other than the conservative one),
/// from which it builds two levels of each pyramid. The coarser levels have a 64th of the grid's voxels and are
/// computed on every rank that has voxels (numerics.md, section 13.2). The result does not depend on the decomposition,
/// to rounding.
///
/// @param domain  the grid and its partition; `Domain(grid)` in a serial program
/// @param light   light of this rank's block
/// @return light of this rank's block; bias and leftOut refer to the domain
/// @throws InvalidInput if an input of the estimator is missing (names it), a setting is out of range, a value of the
///   light is not finite (names the voxel), or ranks disagree; DeviceError; Aborted
ReconstructedLight Reconstruct(Device& device, const Domain& domain, const NoisyLight& light,
  const ReconstructionSettings& settings = {}, const Monitor& monitor = {});
}
