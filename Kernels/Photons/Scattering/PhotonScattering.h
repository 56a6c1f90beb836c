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
/// Scattered light of photons in one channel.
struct ScatteredPhotons
{
  std::vector<float> fluence; ///< W / length^2, one per voxel
  /// W / length^2, 3 per voxel: radiance times direction, integrated; empty if not requested.
  std::vector<float> flow;
  double entered = 0.0;  ///< W
  double absorbed = 0.0; ///< W, before and after the first collision
  /// W of photons that would be scattered once more, or were trapped by total reflection.
  double leftOver = 0.0;
  double exchanged = 0.0;             ///< W, net power added by Russian roulette; its mean is 0
  std::array<double, 6> escaped = {}; ///< W through -x, +x, -y, +y, -z, +z
  std::uint64_t scatterings = 0;
};

/// The medium and phase function in which photons are followed along curved rays through successive scatterings
/// (ScatteringRun), by analog Monte Carlo with absorption by weight and Russian roulette (numerics.md, section 12.5):
/// unbiased for any medium.
///
/// Random numbers come from a counter-based generator keyed by the seed and the photon's number: the same seed gives
/// the same light, bit for bit, for any number of threads and any division of the photons into runs.
class PhotonScattering
{
public:
  /// @param through   the medium in the layout for marching, of one channel; must outlive this
  /// @param medium    the same medium as arrays; read in the constructor only
  /// @param stepPart  fraction of the settings' step size to use: ScatteringStepPart of the whole index
  PhotonScattering(const MarchMedium& through, const Medium& medium, double stepPart);

  struct Settings
  {
    std::uint64_t seed = 1;
    int mostScatterings = 0x7fffffff; ///< maximum number of scatterings of a photon
  };

  /// Ratio of the unit of power to that for uncollided light. A scattered photon may return to a voxel: no sum of so
  /// many times its deposits can exceed 2^62.
  static constexpr double DepositsPerEvent = 4096.0;

private:
  friend class ScatteringRun;

  const MarchMedium& Through;
  double StepPart;
  Buffer<float> Optical;
  SampledPhase Phase;
};

/// Fraction of the usual step size, 0.1 to 1, that is short enough for this refractive index: longer steps across a
/// jump of n^2 lose photons in the denser side (numerics.md, Eq. (99d)). Null values: 1.
double ScatteringStepPart(const Field& ior, const std::array<int, 3>& size);

inline const int* WhereIs(const ScatteredOnItsWay& photon)
{
  return photon.way.voxel;
}

/// Follows photons through successive scatterings, to their ends or, in a block of a grid, until they enter other
/// blocks.
class ScatteringRun
{
public:
  /// @param in, settings  must outlive this
  /// @param photons  photons that start here, of one channel; their unit of power is DepositsPerEvent times that for
  ///   uncollided light
  /// @throws DeviceError if the sums do not fit
  ScatteringRun(const PhotonScattering& in, PackedPhotons photons, const PhotonScattering::Settings& settings);

  /// Follows the photons that start here. @return those that continue in other blocks, in any order. @throws Aborted
  std::vector<ScatteredOnItsWay> Start(const Monitor& monitor);
  /// Follows photons that arrived from other blocks, likewise.
  std::vector<ScatteredOnItsWay> Resume(const std::vector<ScatteredOnItsWay>& arrived, const Monitor& monitor);
  /// The light that all of them deposited, and the tallies of those that ended here.
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
  int Numbers; ///< numbers in a record of the sums
  MarchShares Shares;
  Buffer<float> Photons;
  Buffer<cl_ulong> Streams;
  Buffer<cl_long> Sums;
  cl::Kernel Kernel;
  ScatteredPhotons Found;
};
}
