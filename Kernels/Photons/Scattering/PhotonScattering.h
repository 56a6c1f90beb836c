#pragma once

#include "Device/Batches.h"
#include "Device/Monitor.h"
#include "Photons/Marching/MarchLaunch.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Scattering/SampledPhase.h"
#include "Photons/Scattering/ScatterShared.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// Scattered light of photons, of one channel.
struct ScatteredPhotons
{
  std::vector<float> fluence; ///< W / length^2, by voxel
  std::vector<float> flow;    ///< W / length^2, 3 a voxel: radiance times direction, integrated; empty: not asked for
  double entered = 0.0;       ///< W
  double absorbed = 0.0;      ///< W, before and after the first scattering
  double leftOver = 0.0;      ///< W of photons that would be scattered once more, or were trapped by total reflection
  double exchanged = 0.0;     ///< W that Russian roulette gave less what it took; its mean is 0
  std::array<double, 6> escaped = {}; ///< W through -x, +x, -y, +y, -z, +z
  std::uint64_t scatterings = 0;
};

/// What photons are followed in along bent rays, through scattering after scattering (ScatteringRun), as analog Monte
/// Carlo with absorption by weight and Russian roulette (numerics.md, section 12.5): without bias for any medium.
///
/// Random numbers are drawn by counter, of the seed and a photon's number: the same seed gives the same light, bit for
/// bit, whatever the threads and the parts in which photons are marched.
class PhotonScattering
{
public:
  /// @param through   as photons march through it, of one channel; must stay
  /// @param medium    the same, as data; read here only
  /// @param stepPart  of the settings' step size, that a step has: ScatteringStepPart of all of the index
  PhotonScattering(const MarchMedium& through, const Medium& medium, double stepPart);

  struct Settings
  {
    std::uint64_t seed = 1;
    int mostScatterings = 0x7fffffff; ///< that a photon goes through
  };

  /// Of a photon, which may come back to a voxel: power is scaled such that no sum of so many can exceed 2^62.
  static constexpr double DepositsPerEvent = 4096.0;

private:
  friend class ScatteringRun;

  const MarchMedium& Through;
  double StepPart;
  Buffer<float> Optical;
  SampledPhase Phase;
};

/// Steps across a jump of n^2 that are too long lose photons in the denser side: the part of the usual step that is
/// short enough for this index (numerics.md, Eq. (99d)), 0.1 to 1. Null values: 1.
double ScatteringStepPart(const Field& ior, const std::array<int, 3>& size);

inline const int* WhereIs(const ScatteredOnItsWay& photon)
{
  return photon.way.voxel;
}

/// Photons that are followed through scattering after scattering, as far as their medium goes: to their ends or, where
/// it is a block of a grid, into other blocks.
class ScatteringRun
{
public:
  /// @param in, settings  must outlive this
  /// @param photons  those that set out here, of one channel, in units of DepositsPerEvent times those of uncollided
  ///   light
  /// @throws DeviceError where sums do not fit
  ScatteringRun(const PhotonScattering& in, PackedPhotons photons, const PhotonScattering::Settings& settings);

  /// Those that set out here. @return those that go on in other blocks, in any order. @throws Aborted
  std::vector<ScatteredOnItsWay> Start(const Monitor& monitor);
  /// Those that have come from other blocks, likewise.
  std::vector<ScatteredOnItsWay> Resume(const std::vector<ScatteredOnItsWay>& arrived, const Monitor& monitor);
  /// The light that all of them left, and what became of those that ended here.
  ScatteredPhotons Finish();

private:
  std::vector<ScatteredOnItsWay> Launch(
    const Buffer<ScatteredOnItsWay>& arrived, std::size_t count, bool resumes, const Monitor& monitor);
  cl::Kernel MakeKernel() const;
  Batches LaunchesOf(std::size_t photons) const;
  int Workers() const;
  void TakeLight();
  void TakeEnds(const std::vector<ScatterEnd>& ends);

  const PhotonScattering& In;
  const PhotonScattering::Settings& Settings;
  PackedPhotons Packed;
  int Numbers; ///< of a record of the sums
  MarchShares Shares;
  Buffer<float> Photons;
  Buffer<cl_ulong> Streams;
  Buffer<cl_long> Sums;
  cl::Kernel Kernel;
  ScatteredPhotons Found;
};
}
