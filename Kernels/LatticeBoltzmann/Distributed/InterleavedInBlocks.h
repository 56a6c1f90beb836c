#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LatticeBoltzmann/Distributed/ChannelInBlocks.h"
#include "LatticeBoltzmann/Distributed/LatticeSceneInBlocks.h"
#include "LatticeBoltzmann/Interleaved/PhotonsToCome.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Photons/Distributed/PhotonsInBlocks.h"

#include <memory>
#include <optional>
#include <vector>

namespace tyndall
{
/// Photons that march over ranks, and the light that they have left so far, which diffuses by steps between their
/// turns: InterleavedLattice, turn by turn and step by step, of a medium that is spread over ranks. On each rank
/// photons and lattice take turns on the device.
class InterleavedInBlocks
{
public:
  /// All ranks make one together. What is given must stay, and agree as SolveLatticeInBlocks says.
  InterleavedInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition, const Medium& medium,
    const Field& ior, const Illumination& illumination, const LatticeSettings& settings);

  /// @param marcher  of the same medium, of one order and without batches
  /// @param share  of this rank
  /// @throws  on every rank what one of them throws
  LightField Solve(PhotonMarcherInBlocks& marcher, const std::vector<Photon>& share, const Monitor& monitor);

private:
  void Begin(const PackedPhotons& packed, int channels);
  void Step();
  void Take(const Buffer<float>& fluence);
  void ShineBy(const Buffer<float>& fluence);
  void TakeAll(const PhotonLight& photons);

  /// A channel, and what it takes of the photons.
  struct Channel
  {
    std::unique_ptr<ChannelInBlocks> lattice;
    PhotonChannelMap takes;
    Buffer<float> scatters, glows;
  };

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  const Medium& TheMedium;
  const Field& Index;
  const Illumination& Shining;
  const LatticeSettings& Settings;

  std::optional<PhotonsToCome> ToCome; ///< in this rank's block
  std::optional<LatticeSceneInBlocks> Scene;
  std::vector<float> Directions;
  Uncollided Light; ///< by known voxel, in the units of the scene
  std::vector<Channel> Channels;
  int Steps = 0;
};
}
