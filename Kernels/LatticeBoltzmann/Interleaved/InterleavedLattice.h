#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "LatticeBoltzmann/LatticeChannel.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Grid.h"
#include "Medium/Medium.h"
#include "Photons/Marching/PhotonMarcher.h"
#include "Photons/Marching/PhotonPacking.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace tyndall
{
/// Stand-in for the uncollided light of photons that have not been marched yet, because LatticeProblem chooses units
/// and channels from such light. Its fluence has the order of magnitude of the photons' fluence. It varies from voxel
/// to voxel, and between channels if photons differ in colour, so that the problem keeps all channels that the photons
/// need.
struct PhotonsToCome
{
  /// @param given  number of channels that the photons' light will have
  PhotonsToCome(const PackedPhotons& packed, int given, const Grid& grid);

  UncollidedImage Image() const; ///< this uncollided light by voxel; refers to the arrays of this object

  int channels;
  std::vector<float> fluence; ///< fluence of the stand-in light, [voxel][channel]
  std::array<Rgb, 6> escaped = {};
};

/// Channel of the photons' light that a channel of the problem uses, and the conversion of units.
struct PhotonChannelMap
{
  PhotonChannelMap() = default;
  /// @param photons  uncollided light that the problem was made with
  /// @param solved  `photons` in the problem's units
  /// @param channels, channel  number of channels of the problem, and index of the channel
  PhotonChannelMap(const PhotonsToCome& photons, const UncollidedImage& solved, int channels, int channel);

  int from = 0;         ///< channel of the photons' light
  double fluence = 1.0; ///< lattice units of fluence per unit of the photons' fluence
  double power = 1.0;   ///< lattice units of power per W of the photons
};

/// For each voxel, the fraction of a channel's fluence that is scattered in a step, multiplied by `unit`: the argument
/// `scatters` of Lattice::SetSourceOf.
/// @param unit  conversion factor from the photons' fluence to that of the lattice
/// @param begins  by voxel: fraction of the source that is not absorbed in its first step (LatticeVoxels::begins)
std::vector<float> ScattersOf(const Medium& medium, int channel, double unit, const std::vector<double>& begins);

/// Lattice solve interleaved with photons: photons march while lattice steps diffuse the light deposited so far
/// (Bernabei et al., section III; numerics.md, section 10 c). Stepping continues after the last photon has ended, so
/// that the result is, to the tolerance, the lattice solution for the light of all photons.
class InterleavedLattice
{
public:
  /// All arguments must outlive this.
  /// @param domain  must be serial (one rank)
  InterleavedLattice(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
    const Illumination& illumination, const LatticeSettings& settings);

  /// Marches the photons, and solves for the light.
  /// @param marcher  made for the medium of this object, with settings that end photons at their first collision (one
  ///   order) and keep no separate sums for batches of photons
  LightField Solve(PhotonMarcher& marcher, const std::vector<Photon>& photons, const Monitor& monitor);

private:
  void Begin(const PackedPhotons& packed, int channels);
  std::array<cl::Event, 2> Step(const cl::CommandQueue& queue);
  void Take(const cl::CommandQueue& queue, const Buffer<float>& fluence);
  bool TakeAll(const PhotonLight& photons);

  /// The lattice of one channel, the channel of the photons' light that it uses, and the arguments of
  /// Lattice::SetSourceOf by which its source is updated.
  struct Channel
  {
    std::unique_ptr<LatticeChannel> lattice;
    PhotonChannelMap takes;
    Buffer<float> scatters, emits;
  };

  Device& TheDevice;
  const Domain& TheDomain;
  const Medium& TheMedium;
  const Field& Index;
  const Illumination& Shining;
  const LatticeSettings& Settings;

  std::optional<PhotonsToCome> ToCome;
  std::optional<LatticeProblem> Problem;
  Uncollided Light; ///< light of the photons in the problem's units
  std::vector<Channel> Channels;
  int Steps = 0;
};
}
