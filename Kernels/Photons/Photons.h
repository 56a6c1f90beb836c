#pragma once

#include "Light/LightField.h"
#include "Medium/Grid.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall
{
constexpr int MarchedBatchesAtMost = 64; ///< that PhotonMarcher keeps apart: photons have batches 0 to 63

/// A packet of light: a share of a lamp's power with a place and a direction, not a quantum.
struct Photon
{
  std::array<double, 3> position = {}; ///< where it enters the volume, or where its lamp in the volume is
  std::array<float, 3> direction = { 0.0f, 0.0f, 1.0f }; ///< in which it travels, unit length
  std::array<float, 3> power = {};                       ///< RGB, W
  /// Its power over what it had if its light's photons were spread evenly: large where they are sparse.
  float weight = 1.0f;
  std::int32_t batch = 0; ///< which of the independent sets it belongs to, from 0; each set is a part of all the power
};

/// How paths are followed, and sums kept.
struct MarchSettings
{
  /// Order of the integrator: 2, the leapfrog; 4, Yoshida's three leapfrogs, which pays where n^2 is smooth over
  /// several voxels; 1, explicit Euler, to compare with.
  int order = 2;
  /// Voxels, of a step where the index varies and the octree (if any) has single voxels; 0.05 to 1e4.
  double stepSize = 1.0;
  bool meanDirection = true;
  /// Also photonCount and photonWeight, of up to 16777215 photons: one more number per voxel, in the same pass.
  bool counts = false;
  /// Also batchFluence: separate sums for each of up to MarchedBatchesAtMost batches, on at least as many copies.
  /// Private sums are shared out by whole copies: batches of equal size, as many as compute units or a multiple of
  /// that, keep all of these busy.
  bool batches = false;
  /// Orders of scattering that photons are followed through: 1, up to where they are first scattered (the uncollided
  /// light, without randomness); m, through m - 1 scatterings; 0, until they are absorbed or have left.
  int maximumOrders = 1;
  std::uint64_t seed = 1; ///< of the random numbers by which they are scattered
  /// Batches of photons (one by chance of each so many), up to MarchedBatchesAtMost, of whose light the standard error
  /// is found (fluenceError of the light); 0: it is not wanted. Not together with counts or batches.
  int errorBatches = 0;
  /// Whether light in bricks of 8^3 voxels that hold no medium is kept brick by brick: its mean over the brick, in a
  /// record of its own, which photons cross in one stretch. Where a medium is mostly empty that takes a small part of
  /// the memory and of the time; in voxels of bricks that hold anything the light is the same, to rounding. Applies
  /// where the index is constant (nothing gathers light in empty space then), at least three quarters of the bricks
  /// are empty, and photons are of one order, without counts, batches and Unsafe sums; else light is kept voxel by
  /// voxel as ever.
  bool byBricks = false;
  /// Whether to leave out what the scene does not need; false: three channels and the integrator, to measure what that
  /// saves.
  bool leaveOut = true;

  /// How the sums of many work-items stay whole. All of them give the same light, bit for bit.
  enum class Sums
  {
    Fitting, ///< private ones on a CPU of up to 8 cores and where there are no 64-bit atomics, else shared ones
    Shared,  ///< one set, 64-bit fixed point atomics; needs cl_khr_int64_base_atomics
    Private, ///< a set for each compute unit (as many as fit into memory), added up at the end
    Unsafe,  ///< one set, plain additions by all: loses some. Only to measure what safety costs, and not by batches
  };
  Sums sums = Sums::Fitting;
};

/// @throws InvalidInput where the order is not 1, 2 or 4, the step size not 0.05 to 1e4 voxels, sums are Unsafe and
///   batches asked for, maximumOrders is negative, errorBatches are 1 or not 0 to MarchedBatchesAtMost,
///   or asked for together with counts or batches, or batches with other orders than 1
void Check(const MarchSettings& settings);

/// The path of one photon: positions, and the part of its power (all channels together) that is left there; 1 where it
/// had none.
struct PhotonPath
{
  std::size_t photon = 0; ///< its number
  std::vector<std::array<double, 3>> points;
  std::vector<float> left;
};

/// Light that photons carried into a medium.
struct PhotonLight
{
  /// Of one order: light that was not scattered, so that fluenceDirect would be the same and is left empty. Balance:
  /// `absorbed` is what the medium absorbed and what it scattered, `leftOver` what still went round when the photon was
  /// given up (total reflection can trap it). Of more orders: all light, fluenceDirect what was not scattered,
  /// `absorbed` what the medium absorbed, `leftOver` what would be scattered once more too, less what Russian roulette
  /// gave.
  LightField light;
  Rgb scattered = {};            ///< W, that is scattered for the first time
  std::uint64_t scatterings = 0; ///< that photons went through, of more orders than one
  Rgb exchanged = {};            ///< W, that Russian roulette gave less what it took; 0 in the mean
  /// 3 per voxel: sum of power times direction over sum of power, at most 1 long; empty: not asked for. Coarse in
  /// voxels so dark that they gained a few units of fixed point only, some 2^-62 of all power times the longest path.
  std::vector<float> meanDirection;
  /// Photons that crossed each voxel before they were dark; each counts once, and once more each time it comes back.
  /// Empty: not asked for.
  std::vector<float> photonCount;
  /// Their mean `weight`, 0 where there is none, to 1e-4 of the largest. Empty: not asked for.
  std::vector<float> photonWeight;
  int batches = 1; ///< that the photons have: the largest `batch` and one
  /// fluence by each batch alone, [voxel][batch][channel], as if it was all the light: their mean is `fluence`. Empty:
  /// not asked for.
  std::vector<float> batchFluence;
  std::size_t missed = 0;       ///< photons whose ways do not meet the volume; they are not among what entered
  std::size_t deposits = 0;     ///< stretches of path that were deposited to voxels
  std::size_t steps = 0;        ///< of the integrator
  double secondsMarching = 0.0; ///< from sorted photons to sums on the device
  double seconds = 0.0;         ///< from photons to light
};

/// Light of pilot photons in coarse cells that fill the medium's box (Pfeuti 2009, section 3.2.2). Arrays have x
/// fastest.
struct PilotLight
{
  Grid grid; ///< the coarse cells; where they do not divide the voxels evenly, some have a voxel more than others
  int channels = 1;           ///< of fluence
  std::vector<float> fluence; ///< W / length^2, the mean over each cell's voxels
  std::vector<float> count;   ///< photons that crossed each cell, each once
  /// 2 per cell: mean column and row that its photons start from, 0 where there is none; their standard deviation.
  std::vector<float> originMean, originDeviation;
  double seconds = 0.0;
};
}
