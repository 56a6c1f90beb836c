#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"

#include <string>
#include <vector>

namespace tyndall
{
constexpr int ComparedBatchesAtMost = 16; ///< largest number of batches for the conservative estimator

/// Light from a photon simulation, with its noise. Arrays have one entry per voxel of a rank's block, x fastest; null
/// where absent.
struct NoisyLight
{
  Grid grid;                            ///< grid of the arrays; Reconstruct takes it from its domain
  int channels = 1;                     ///< channels of fluence: 1 or 3
  const float* fluence = nullptr;       ///< W / length^2; not read by the conservative estimator
  const float* meanDirection = nullptr; ///< 3 per voxel; optional
  const float* photonCount = nullptr;   ///< photons in each voxel; for the published and the nearest-photons estimator
  const float* photonWeight = nullptr;  ///< mean weight of these photons; for the published estimator
  int batches = 1;
  /// [voxel][batch][channel], W / length^2; for the conservative estimator, with 2 to ComparedBatchesAtMost batches,
  /// whose mean is the fluence.
  const float* batchFluence = nullptr;
};

struct ReconstructionSettings
{
  enum class Estimator
  {
    /// level from centre-surround differences and from photon weight, the lower of the two (Pfeuti 2009, section 3.2.4)
    Published,
    Conservative,   ///< keeps each level's detail as far as independent batches agree on it; estimates the error
    ConstantRadius, ///< the same level for all voxels (section 4.2)
    NearestPhotons, ///< the lowest level with at least `nearest` photons (section 4.2)
  };
  Estimator estimator = Estimator::Conservative;
  int levels = 5; ///< largest number of pyramid levels above the grid, 1 to 8; limited by the grid's size
  /// Published: increment of photon weight from level to level; 0: 0.999 times the mean weight of lit voxels.
  double weightStep = 0.0;
  int level = 1;        ///< ConstantRadius: the level
  int nearest = 20;     ///< NearestPhotons: number of photons, at least 1
  bool conserve = true; ///< scale the light such that its total over the volume is unchanged
};

struct ReconstructedLight
{
  std::vector<float> fluence;       ///< W / length^2, as many channels as the input, >= 0
  std::vector<float> meanDirection; ///< 3 per voxel, length at most 1; empty if the input has none
  /// Pyramid level that each voxel's light was taken from; fractional where levels are blended.
  std::vector<float> mipLevel;
  /// Standard error, `channels` per voxel, W / length^2; empty unless the estimator is Conservative.
  std::vector<float> fluenceError;
  /// Relative change of the light's total over all channels, before it is rescaled to be conserved.
  double bias = 0.0;
  std::vector<std::string> leftOut;
  std::string device;
  double seconds = 0.0;
};

/// Reduces the noise of photon light with pyramids. Lengths are in voxels (spacing does not matter); for grids of odd
/// size the last voxel is treated as if it were repeated.
///
/// Conservative (numerics.md, Eqs. (101) to (104)): builds a Laplacian pyramid of each batch (down by weights 1 3 3 1
/// along each axis, up by trilinear interpolation). Batches agree on light but not on noise; their differences give a
/// Wiener gain for the detail of each level, the fraction of it that is kept. fluenceError covers the noise that was
/// kept and the light that was mistaken for noise. Negative light is set to 0. Mean directions are smoothed as flux
/// (fluence times direction) with the same gains. Light of three channels that has the same colour everywhere is
/// smoothed by the sum of its channels, which share one relative error; where colours differ, each channel is smoothed
/// separately and has its own error.
///
/// Published (Pfeuti 2009, section 3.2.4, listings B.2, B.3; numerics.md, Eq. (100)): takes the lower of two levels:
/// the one up to which the difference of successive levels does not grow, and the photon weight divided by
/// `weightStep`, with the weight from the first level that contains at least one photon. The light and directions of
/// this estimator, of constant radius and of nearest photons are interpolated trilinearly in a pyramid built with a
/// 4x4x4 Gaussian kernel.
///
/// Collective. Each rank stores its block with a halo of 32 voxels (16 for the estimators other than the conservative
/// one), from which it builds two levels of each pyramid; the levels above, a 64th of the grid, are computed
/// redundantly on every rank that has voxels (numerics.md, section 13.2). The result does not depend on the
/// decomposition, to rounding.
///
/// @param domain  the domain; `Domain(grid)` in a serial program
/// @param light   light of the rank's block
/// @return light of the rank's block; bias and leftOut refer to the whole domain
/// @throws InvalidInput if an input of the estimator is missing (names it), a setting is out of its range, a value of
///   the light is not finite (names the voxel), or ranks disagree; DeviceError; Aborted
ReconstructedLight Reconstruct(Device& device, const Domain& domain, const NoisyLight& light,
  const ReconstructionSettings& settings = {}, const Monitor& monitor = {});
}
