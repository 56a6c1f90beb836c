#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/LatticeChannel.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/LightField.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Photons/Marching/PhotonMarcher.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace tyndall
{
/// Photons that march, and the light that they have left so far, which diffuses by steps while they march on (Bernabei
/// et al., section III; numerics.md, section 10 c). The light is that of the lattice under all the photons' light, to
/// the tolerance: steps go on after the last photon has come to its end.
class InterleavedLattice
{
public:
  /// What is given must stay.
  InterleavedLattice(Device& device, const Medium& medium, const Field& ior, const Illumination& illumination,
    const LatticeSettings& settings);

  /// @param marcher  of the same medium, of one order and without batches
  LightField Solve(PhotonMarcher& marcher, const std::vector<Photon>& photons, const Monitor& monitor);

private:
  void Begin(const PackedPhotons& packed, int channels);
  void StandInFor(const PackedPhotons& packed, int channels);
  std::array<cl::Event, 2> Step(const cl::CommandQueue& queue);
  void Take(const cl::CommandQueue& queue, const Buffer<float>& fluence);
  void TakeAll(const PhotonLight& photons);
  int StepsOfTurn() const;

  /// A channel, and which of the photons' it takes.
  struct Channel
  {
    std::unique_ptr<LatticeChannel> lattice;
    int from = 0;         ///< channel of the photons' light
    double fluence = 1.0; ///< of the lattice's units, in one of the photons'
    double power = 1.0;   ///< the same of power
    Buffer<float> scatters, glows;
  };

  Device& TheDevice;
  const Medium& TheMedium;
  const Field& Index;
  const Illumination& Shining;
  const LatticeSettings& Settings;

  std::vector<float> StandIn; ///< for the photons' light, in place of which the problem is put
  std::array<Rgb, 6> StandInEscaped = {};
  int PhotonChannels = 1;
  std::optional<PropagationProblem> Problem;
  Uncollided Light; ///< in the problem's units
  std::vector<Channel> Channels;
  int Steps = 0;
};
}
