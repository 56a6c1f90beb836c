#pragma once

#include "Light/LightField.h"
#include "Medium/Grid.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tyndall
{
/// Maximum number of photon batches whose light PhotonMarcher sums separately: Photon::batch is 0 to 63.
constexpr int MarchedBatchesAtMost = 64;

/// A photon packet: a fraction of a light's power with a position and a direction, not a quantum.
struct Photon
{
  /// Point where the photon enters the volume or, for a lamp inside the volume, the position of the lamp.
  std::array<double, 3> position = {};
  std::array<float, 3> direction = { 0.0f, 0.0f, 1.0f }; ///< direction of travel, unit length
  std::array<float, 3> power = {};                       ///< power of each channel (RGB), W
  /// Ratio of the photon's power to the power that it would have if its light emitted photons of uniform density. Large
  /// where photons are sparse.
  float weight = 1.0f;
  /// Index of the photon's batch, from 0. Batches are independent samples, each of which carries a part of the power.
  std::int32_t batch = 0;
};

/// Settings of the path integrator and of the sums of photons' deposits in voxels.
struct MarchSettings
{
  /// Order of the path integrator: 2, one leapfrog per step; 4, Yoshida's three leapfrogs, more efficient where n^2
  /// is smooth over several voxels; 1, explicit Euler, for comparison.
  int order = 2;
  /// Length of a step of the path integrator, in voxels, where the index varies and the octree (if any) has single
  /// voxels; 0.05 to 1e4.
  double stepSize = 1.0;
  bool meanDirection = true;
  /// Whether photonCount and photonWeight are returned, for up to 16777215 photons. They need one more number per
  /// voxel.
  bool counts = false;
  /// Whether batchFluence is returned. It needs separate sums, and so at least one copy of the sums, for each of up to
  /// MarchedBatchesAtMost batches. With Sums::Private each copy is filled by one compute unit and belongs to one batch.
  /// To keep all compute units busy, use batches of equal size, whose number is the number of compute units or a
  /// multiple of it.
  bool batches = false;
  /// Number of scattering orders that photons are followed through. 1: up to their first collision (the uncollided
  /// flux, without randomness); m: through m - 1 scatterings; 0: until they are absorbed or have escaped.
  int maximumOrders = 1;
  std::uint64_t seed = 1; ///< seed of the random numbers that scatter photons
  /// Number of random batches of photons, up to MarchedBatchesAtMost, from which the standard error (fluenceError of
  /// the light) is estimated; 0: no standard error. Cannot be combined with counts or batches.
  int errorBatches = 0;
  /// Whether a brick of 8^3 voxels without medium stores only its mean light, in one record, and is crossed by photons
  /// in one segment. In a mostly empty medium this takes a small fraction of the memory and of the time. In the voxels
  /// of bricks that hold medium the light agrees to rounding. Takes effect only if the index is constant (empty space
  /// then focuses no light), at least three quarters of the bricks are empty, and photons are followed through one
  /// order, without counts and batches. Otherwise light is stored voxel by voxel.
  bool byBricks = false;
  /// Whether kernels are compiled without the path integrator, and with one channel, if that suffices for the scene.
  /// With false, kernels always have three channels and the integrator, to measure the saving.
  bool leaveOut = true;

  /// How concurrent additions to the same sum are kept from losing deposits. All choices give the same light, bit for
  /// bit.
  enum class Sums
  {
    Fitting, ///< Private on a CPU of up to 8 cores and on devices without 64-bit atomics, Shared otherwise
    Shared,  ///< one copy of the sums, 64-bit fixed-point atomics; needs cl_khr_int64_base_atomics
    Private, ///< a copy of the sums for each compute unit (as many as fit into memory), added up at the end
  };
  Sums sums = Sums::Fitting;
};

/// Checks the settings of a march.
/// @throws InvalidInput if the order is not 1, 2 or 4, the step size is not 0.05 to 1e4 voxels, maximumOrders is
///   negative, errorBatches is 1, outside 0 to MarchedBatchesAtMost or combined with counts or batches, or batches are
///   combined with maximumOrders other than 1
void Check(const MarchSettings& settings);

/// The path of one photon.
struct PhotonPath
{
  std::size_t photon = 0; ///< index of the photon in the array of photons that were marched
  /// Points of the path: its start, each point where it changes direction, and its end, world coordinates.
  std::vector<std::array<double, 3>> points;
  std::vector<float> left; ///< fraction of the photon's power (sum of channels) left at each corner; 1 if it had none
};

/// Light that photons deposited in a medium, with its energy balance and statistics.
struct PhotonLight
{
  /// Light of all scattering orders, with its energy balance.
  /// With maximumOrders = 1 it is the uncollided light alone. fluenceDirect would be equal and is left empty; the
  /// energy balance counts first-scattered power as `absorbed`; its `leftOver` is the power of photons terminated
  /// before they escaped (total reflection can trap them).
  /// With more orders, fluenceDirect is the uncollided light, and `absorbed` is absorption alone. `leftOver` then also
  /// includes power that would be scattered once more, less the net power added by Russian roulette.
  LightField light;
  Rgb scattered = {};            ///< W, power scattered for the first time
  std::uint64_t scatterings = 0; ///< number of scatterings of all photons; 0 with a single scattering order
  Rgb exchanged = {};            ///< W, net power added by Russian roulette; its expected value is 0
  /// Mean direction of the light, three values per voxel: sum of power times direction over sum of power, of length at
  /// most 1. Empty if not requested. It is coarse in voxels so dark that their sum is a few fixed-point units; a unit
  /// is about 2^-62 of all power times the longest path.
  std::vector<float> meanDirection;
  /// Number of photons that crossed each voxel with power above 0; a photon counts again each time it re-enters.
  /// Empty if not requested.
  std::vector<float> photonCount;
  /// Mean Photon::weight of the photons counted in photonCount, 0 in voxels without any, accurate to 1e-4 of the
  /// largest. Empty if not requested.
  std::vector<float> photonWeight;
  int batches = 1; ///< number of batches: the largest Photon::batch plus one
  /// Fluence that each batch of photons gives if it carries all the power, [voxel][batch][channel]. The mean over
  /// batches is `light.fluence`. Empty if not requested.
  std::vector<float> batchFluence;
  std::size_t missed = 0;   ///< number of photons whose lines miss the volume; their power does not count as entered
  std::size_t deposits = 0; ///< number of path segments whose light was added to the sums of voxels
  std::size_t steps = 0;    ///< number of steps of the integrator
  /// Duration of the march of uncollided photons, from packed photons to their light on the host, s.
  double secondsMarching = 0.0;
  double seconds = 0.0; ///< total duration, from the given photons to the light on the host, s
};

/// Light of pilot photons in coarse cells that fill the medium's box (Pfeuti 2009, section 3.2.2). Pilot photons are a
/// small first set; their light decides how the final photons are distributed. In all arrays x varies fastest.
struct PilotLight
{
  /// Grid of the coarse cells. Where their number does not divide the number of voxels, some cells are one voxel
  /// longer than others.
  Grid grid;
  int channels = 1;           ///< number of channels of `fluence`
  std::vector<float> fluence; ///< W / length^2, mean over the voxels of each cell, channels fastest
  std::vector<float> count;   ///< number of photons that crossed each cell, each photon once
  /// Mean and standard deviation of the origins of the photons that crossed each cell, 2 values per cell; 0 in cells
  /// without photons. An origin is the column and row in the square grid on the photon plane, the plane from which the
  /// light's photons start.
  std::vector<float> originMean, originDeviation;
  std::vector<std::string> leftOut; ///< what the march left out (LeftOut.h)
  double seconds = 0.0;             ///< duration, s
};
}
