#pragma once

#include "Light/LightField.h"
#include "Medium/Grid.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// Maximum number of batches that PhotonMarcher keeps apart: Photon::batch is 0 to 63.
constexpr int MarchedBatchesAtMost = 64;

/// A photon packet: a share of a light's power with a position and a direction, not a quantum.
struct Photon
{
  /// Where it enters the volume, or the position of its lamp inside the volume.
  std::array<double, 3> position = {};
  std::array<float, 3> direction = { 0.0f, 0.0f, 1.0f }; ///< direction of travel, unit length
  std::array<float, 3> power = {};                       ///< RGB, W
  /// Ratio of its power to the power it would have if the photons of its light were spread evenly: large where photons
  /// are sparse.
  float weight = 1.0f;
  /// The independent batch that it belongs to, from 0; each batch carries a part of all the power.
  std::int32_t batch = 0;
};

/// Settings of the path integrator and of the sums of deposits.
struct MarchSettings
{
  /// Order of the integrator: 2, the leapfrog; 4, Yoshida's three leapfrogs, which pays where n^2 is smooth over
  /// several voxels; 1, explicit Euler, to compare with.
  int order = 2;
  /// Length of a step, in voxels, where the index varies and the octree (if any) has single voxels; 0.05 to 1e4.
  double stepSize = 1.0;
  bool meanDirection = true;
  /// Also return photonCount and photonWeight, for up to 16777215 photons: one more number per voxel, in the same pass.
  bool counts = false;
  /// Also return batchFluence: separate sums for each of up to MarchedBatchesAtMost batches, which need at least as
  /// many copies of the sums. Private sums are distributed among compute units by whole copies: to keep all compute
  /// units busy, use batches of equal size, as many as there are compute units or a multiple of that.
  bool batches = false;
  /// Number of scattering orders that photons are followed through. 1: up to their first collision (the uncollided
  /// flux, without randomness); m: through m - 1 scatterings; 0: until they are absorbed or have escaped.
  int maximumOrders = 1;
  std::uint64_t seed = 1; ///< seed of the random numbers that scatter photons
  /// Number of random batches of photons, up to MarchedBatchesAtMost, from which the standard error (fluenceError of
  /// the light) is estimated; 0: no standard error. Cannot be combined with counts or batches.
  int errorBatches = 0;
  /// Whether bricks of 8^3 voxels that hold no medium store only their mean light, in one record, and are crossed by
  /// photons in one segment. In a mostly empty medium this takes a small part of the memory and of the time; in voxels
  /// of bricks that hold any medium the light is the same, to rounding. Takes effect only if the index is constant
  /// (empty space then focuses no light), at least three quarters of the bricks are empty, and photons are followed
  /// through one order, without counts and batches; otherwise light is stored voxel by voxel.
  bool byBricks = false;
  /// Whether kernels leave out what the scene does not need; false: kernels always have three channels and the
  /// integrator, to measure the saving.
  bool leaveOut = true;

  /// How concurrent additions to the same sums are kept from losing deposits. All give the same light, bit for bit.
  enum class Sums
  {
    Fitting, ///< Private on a CPU of up to 8 cores and on devices without 64-bit atomics, else Shared
    Shared,  ///< one copy, 64-bit fixed-point atomics; needs cl_khr_int64_base_atomics
    Private, ///< a copy for each compute unit (as many as fit into memory), added up at the end
  };
  Sums sums = Sums::Fitting;
};

/// @throws InvalidInput if the order is not 1, 2 or 4, the step size is not 0.05 to 1e4 voxels, maximumOrders is
///   negative, errorBatches is 1, outside 0 to MarchedBatchesAtMost or combined with counts or batches, or batches are
///   combined with maximumOrders other than 1
void Check(const MarchSettings& settings);

/// The path of one photon: its corners, and the fraction of its power (all channels together) that is left at each; 1
/// if it had none.
struct PhotonPath
{
  std::size_t photon = 0; ///< index of the photon
  std::vector<std::array<double, 3>> points;
  std::vector<float> left;
};

/// Light that photons deposited in a medium.
struct PhotonLight
{
  /// With maximumOrders = 1, the uncollided light; fluenceDirect would be equal and is left empty. In its energy
  /// balance `absorbed` includes first-scattered power, and `leftOver` is the power of photons given up before they
  /// escaped (total reflection can trap them). With more orders, the light of all orders; fluenceDirect is its
  /// uncollided part, `absorbed` is absorption alone, and `leftOver` also includes power that would be scattered once
  /// more, less the net power added by Russian roulette.
  LightField light;
  Rgb scattered = {};            ///< W, scattered for the first time
  std::uint64_t scatterings = 0; ///< number of scattering events, if there is more than one order
  Rgb exchanged = {};            ///< W, net power added by Russian roulette; its mean is 0
  /// Three values per voxel: sum of power times direction over sum of power, of length at most 1. Empty if not
  /// requested. Coarse in voxels so dark that their sum is a few units of fixed point, some 2^-62 of all power times
  /// the longest path.
  std::vector<float> meanDirection;
  /// Number of photons that crossed each voxel with power left; a photon counts again each time it re-enters. Empty if
  /// not requested.
  std::vector<float> photonCount;
  /// Mean `weight` of these photons, 0 where there are none, accurate to 1e-4 of the largest. Empty if not requested.
  std::vector<float> photonWeight;
  int batches = 1; ///< number of batches: the largest Photon::batch plus one
  /// Fluence estimated from each batch alone, as if it carried all the power, [voxel][batch][channel]: the mean over
  /// batches is `fluence`. Empty if not requested.
  std::vector<float> batchFluence;
  std::size_t missed = 0;       ///< photons whose lines miss the volume; they do not count as entered
  std::size_t deposits = 0;     ///< path segments deposited in voxels
  std::size_t steps = 0;        ///< steps of the integrator
  double secondsMarching = 0.0; ///< from sorted photons to sums on the device
  double seconds = 0.0;         ///< from photons to light
};

/// Light of pilot photons in coarse cells that fill the medium's box (Pfeuti 2009, section 3.2.2). Arrays have x
/// fastest.
struct PilotLight
{
  /// The coarse cells; where they do not divide the voxels evenly, some have one voxel more than others.
  Grid grid;
  int channels = 1;           ///< channels of fluence
  std::vector<float> fluence; ///< W / length^2, the mean over each cell's voxels
  std::vector<float> count;   ///< number of photons that crossed each cell, each photon once
  /// Mean and standard deviation of the column and row from which a cell's photons start, 2 values per cell; 0 where a
  /// cell has none.
  std::vector<float> originMean, originDeviation;
  double seconds = 0.0;
};
}
