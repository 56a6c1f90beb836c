#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/Interleaved/PhotonsToCome.h"
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
/// Steps of a turn of photons, after so many that were done. The last one that is asked for is done when all photons
/// have come to their ends.
int StepsOfTurn(const LatticeSettings& settings, int done);

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
  std::array<cl::Event, 2> Step(const cl::CommandQueue& queue);
  void Take(const cl::CommandQueue& queue, const Buffer<float>& fluence);
  void TakeAll(const PhotonLight& photons);

  /// A channel, and what it takes of the photons.
  struct Channel
  {
    std::unique_ptr<LatticeChannel> lattice;
    PhotonChannelMap takes;
    Buffer<float> scatters, glows;
  };

  Device& TheDevice;
  const Medium& TheMedium;
  const Field& Index;
  const Illumination& Shining;
  const LatticeSettings& Settings;

  std::optional<PhotonsToCome> ToCome;
  std::optional<PropagationProblem> Problem;
  Uncollided Light; ///< in the problem's units
  std::vector<Channel> Channels;
  int Steps = 0;
};
}
