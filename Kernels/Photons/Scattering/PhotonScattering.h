#pragma once

#include "Device/Monitor.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Marching/MarchRun.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
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

/// Samples the cosine of the scattering angle (numerics.md, Eqs. (99b), (99c)): in closed form for isotropic scattering
/// and for the Henyey-Greenstein and Schlick phase functions, whose parameter may vary by voxel; otherwise from a table
/// of the inverse cumulative distribution at 65536 equal steps of probability.
struct SampledPhase
{
  /// @param medium  a medium of one channel
  SampledPhase(Device& device, const Medium& medium);

  std::string options;  ///< of ScatterPhotons.cl
  Buffer<float> values; ///< the parameter, one or one per voxel; or the table
};

/// The medium and phase function in which photons are followed along curved rays through successive scatterings
/// (ScatteringRun), by analog Monte Carlo with absorption by weight and Russian roulette (numerics.md, section 12.5):
/// unbiased for any medium.
///
/// Random numbers come from a counter-based generator keyed by the seed and the photon's number: the same seed gives
/// the same light, bit for bit, for any number of threads and any division of the photons into runs.
struct PhotonScattering
{
  /// @param through   the medium in the layout for marching, of one channel; must outlive this
  /// @param medium    the same medium as arrays; read in the constructor only
  /// @param stepPart  fraction of the settings' step size to use: ScatteringStepPart of the whole index
  PhotonScattering(const MarchMedium& through, const Medium& medium, double stepPart);

  /// Ratio of the unit of power to that for uncollided light. A scattered photon may return to a voxel: no sum of so
  /// many times its deposits can exceed 2^62.
  static constexpr double DepositsPerEvent = 4096.0;

  const MarchMedium& through;
  double stepPart;
  Buffer<float> optical; ///< sigma_s and sigma_a times the voxel diagonal in the padded grid
  SampledPhase phase;
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
  /// @param in  must outlive this
  /// @param photons  photons that start here, of one channel; their unit of power is DepositsPerEvent times that for
  ///   uncollided light
  /// @throws DeviceError if the sums do not fit
  ScatteringRun(const PhotonScattering& in, PackedPhotons photons);

  /// Follows the photons that start here. @return those that continue in other blocks, in any order. @throws Aborted
  std::vector<ScatteredOnItsWay> Start(const Monitor& monitor);
  /// Follows photons that arrived from other blocks, likewise.
  std::vector<ScatteredOnItsWay> Resume(const std::vector<ScatteredOnItsWay>& arrived, const Monitor& monitor);
  /// The light that all of them deposited, and the tallies of those that ended here.
  ScatteredPhotons Finish();

private:
  std::vector<ScatteredOnItsWay> Launch(
    const cl::Buffer& photons, std::size_t count, bool resumes, const Monitor& monitor);
  cl::Kernel MakeKernel() const;
  int Workers() const;
  void TakeLight();
  void TakeEnds(const std::vector<ScatterEnd>& ends);

  const PhotonScattering& In;
  PackedPhotons Packed;
  int Numbers; ///< numbers in a record of the sums
  MarchShares Shares;
  Buffer<float> Photons;
  Buffer<cl_ulong> Streams;
  Buffer<cl_long> Sums;
  cl::Kernel Kernel;
  ScatteredPhotons Found;
};

/// Scattered light of photons in all channels: one run if medium and light have one colour, else one run per channel
/// with the same random numbers, so that colours share their noise.
class ScatteredChannels
{
public:
  /// A rank's block of a medium.
  struct Block
  {
    const MarchMedium* through; ///< must outlive this; null if the rank has no voxels
    const Medium& medium;       ///< read in the constructor only, and only if there are voxels
    Field ior;                  ///< in the voxels of the block and its halo
    const std::uint8_t* levels; ///< of the octree; null: no octree
    // The same for all blocks.
    const MarchSettings& settings;
    double stepPart;           ///< ScatteringStepPart of the whole index
    bool coloured;             ///< whether channels differ in their coefficients or phase functions
    const BrickedBytes* nodes; ///< argument of MarchMedium::SetNodes; null: `levels` cover the whole grid
  };
  ScatteredChannels(Device& device, const Block& block);

  /// Whether coefficients or the phase function have colour.
  bool HasColour() const { return this->Channels.size() > 1; }

  /// Follows photons of one channel to their ends. @param in  null if this rank has no voxels
  using Follower =
    std::function<ScatteredPhotons(const PhotonScattering* in, PackedPhotons photons, const Monitor& monitor)>;
  /// Adds scattered light to the uncollided light that the same photons deposited.
  /// @param packed  the photons as they were packed for the uncollided light
  void AddTo(PhotonLight& light, const PackedPhotons& packed, const Monitor& monitor, const Follower& follow) const;

private:
  struct Channel
  {
    std::unique_ptr<const MarchMedium> own; ///< of one channel of a coloured medium
    std::unique_ptr<PhotonScattering> photons;
  };
  static Rgb ColourOfRun(const PackedPhotons& packed, bool oneRun, int run);

  std::vector<Channel> Channels;
};
}
