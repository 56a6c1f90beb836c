#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "LatticeBoltzmann/Interleaved/PhotonsToCome.h"
#include "LatticeBoltzmann/LatticeChannel.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Photons/Marching/PhotonMarcher.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace tyndall
{
/// Marches photons while lattice steps diffuse the light deposited so far (Bernabei et al., section III; numerics.md,
/// section 10 c). Stepping continues after the last photon has ended, so that the result is, to the tolerance, the
/// lattice solution for the light of all photons.
class InterleavedLattice
{
public:
  /// All arguments must outlive this.
  /// @param domain  must be serial (one rank)
  InterleavedLattice(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
    const Illumination& illumination, const LatticeSettings& settings);

  /// @param marcher  set up for the same medium, one scattering order and no batches
  LightField Solve(PhotonMarcher& marcher, const std::vector<Photon>& photons, const Monitor& monitor);

private:
  void Begin(const PackedPhotons& packed, int channels);
  std::array<cl::Event, 2> Step(const cl::CommandQueue& queue);
  void Take(const cl::CommandQueue& queue, const Buffer<float>& fluence);
  void TakeAll(const PhotonLight& photons);

  /// A lattice channel and its share of the photons' light.
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
  Uncollided Light; ///< photons' light in the problem's units
  std::vector<Channel> Channels;
  int Steps = 0;
};
}
