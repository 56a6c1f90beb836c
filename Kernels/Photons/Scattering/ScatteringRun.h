#pragma once

#include "Device/Batches.h"
#include "Photons/Marching/MarchLaunch.h"
#include "Photons/Scattering/PhotonScattering.h"
#include "Photons/Scattering/ScatterShared.h"

#include <vector>

namespace tyndall
{
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
