#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"

#include <string>
#include <vector>

namespace tyndall
{
constexpr int ComparedBatchesAtMost = 16; ///< that the conservative estimator compares

/// Light as photons left it, not filtered. Arrays are over the voxels of a rank's block, x fastest; null where there is
/// none.
struct NoisyLight
{
  Grid grid;                            ///< of the arrays; Reconstruct takes that of its domain
  int channels = 1;                     ///< of fluence: 1 or 3
  const float* fluence = nullptr;       ///< W / length^2; not read by the conservative estimator
  const float* meanDirection = nullptr; ///< 3 per voxel; optional
  const float* photonCount = nullptr;   ///< photons in each voxel; for the published and the nearest estimator
  const float* photonWeight = nullptr;  ///< their mean weight; for the published one
  int batches = 1;
  /// [voxel][batch][channel]; for the conservative estimator, 2 to ComparedBatchesAtMost, whose mean is fluence.
  const float* batchFluence = nullptr;
};

struct ReconstructionSettings
{
  enum class Estimator
  {
    Published,      ///< level by centre-surround and photon weight, the lower of the two (Pfeuti 2009, section 3.2.4)
    Conservative,   ///< each level's detail is kept as far as independent batches agree on it; has an error
    ConstantRadius, ///< one level everywhere (section 4.2)
    NearestPhotons, ///< the lowest level that holds `nearest` photons (section 4.2)
  };
  Estimator estimator = Estimator::Conservative;
  int levels = 5; ///< of the pyramid above the grid, at most; 1 to 8, and no more than the grid has
  /// Published: weight of photons from a level to the next; 0: the mean weight of lit voxels, less 1e-3.
  double weightStep = 0.0;
  int level = 1;        ///< constant radius: which
  int nearest = 20;     ///< nearest photons: how many, at least 1
  bool conserve = true; ///< scale the light such that the volume's total is what it was
};

struct ReconstructedLight
{
  std::vector<float> fluence;       ///< as many channels as there were, >= 0
  std::vector<float> meanDirection; ///< 3 per voxel, at most 1 long; empty where there was none
  /// Level of the pyramid that each voxel's light was taken from; between two where blended.
  std::vector<float> mipLevel;
  /// Standard error, `channels` per voxel, W / length^2; conservative only, else empty.
  std::vector<float> fluenceError;
  /// Total of the light, all channels, over what it was, less 1; before it was scaled where the total is conserved.
  double bias = 0.0;
  std::vector<std::string> leftOut;
  std::string device;
  double seconds = 0.0;
};

/// Light without most of its noise, over pyramids in voxels (spacing does not matter); grids of odd sizes as if their
/// last voxel was repeated.
///
/// Conservative (numerics.md, Eqs. (101) to (104)): a Laplacian pyramid of each batch (down by 1 3 3 1 along each axis,
/// up trilinear). Batches agree on light and not on noise, which gives for each level's detail the gain of a Wiener
/// filter: how much of it to keep. fluenceError is of the noise that was kept and of the light that was held for noise.
/// Light below 0 becomes 0. Mean directions are smoothed as flux, fluence times direction, with the same gains. Light
/// of three channels and one colour everywhere is smoothed by their sum, whose error they share; where colours differ
/// each channel is smoothed by itself, and has an error of its own.
///
/// Published (Pfeuti 2009, section 3.2.4, listings B.2, B.3; numerics.md, Eq. (100)): the lower of the level up to
/// which the difference of two successive levels does not grow, and the weight over `weightStep`, the weight from the
/// first level with at least one photon. Its light and directions, those of constant radius and of nearest photons are
/// trilinear in a pyramid by a Gauss kernel of 4x4x4.
///
/// Collective. Each rank has its block and 32 voxels around it (16 for the estimators other than the conservative one),
/// of which it makes two levels of each pyramid; the levels above, a 64th of the grid, are made on every rank that has
/// voxels (numerics.md, section 13.2). The light does not depend on the blocks, to rounding.
///
/// @param domain  the grid; `Domain(grid)` for serial light
/// @param light   of the rank's block
/// @return arrays of the block; bias and leftOut of the whole grid
/// @throws InvalidInput where what the estimator needs is missing (says what), a setting is out of its range, a number
///   of the light is not finite (names the voxel), or ranks disagree; DeviceError; Aborted
ReconstructedLight Reconstruct(Device& device, const Domain& domain, const NoisyLight& light,
  const ReconstructionSettings& settings = {}, const Monitor& monitor = {});
}
