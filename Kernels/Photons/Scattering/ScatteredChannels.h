#pragma once

#include "Photons/Scattering/PhotonScattering.h"

#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
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
  using Follower = std::function<ScatteredPhotons(const PhotonScattering* in, PackedPhotons photons,
    const PhotonScattering::Settings& settings, const Monitor& monitor)>;
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

  MarchSettings Settings;
  std::vector<Channel> Channels;
};
}
