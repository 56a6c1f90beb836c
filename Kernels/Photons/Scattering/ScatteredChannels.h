#pragma once

#include "Photons/Scattering/PhotonScattering.h"

#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// Scattered photons of all channels: one run where medium and light have one colour, else a run for each channel, with
/// the same random numbers, so that colours do not have a noise of their own.
class ScatteredChannels
{
public:
  /// A rank's block of a medium.
  struct Block
  {
    const MarchMedium* through; ///< must outlive this; null: no voxels
    const Medium& medium;       ///< read in the constructor only, and not without voxels
    Field ior;                  ///< of the voxels whose index the block knows
    const std::uint8_t* levels; ///< of the octree; null: there is none
    // Of all blocks alike.
    const MarchSettings& settings;
    double stepPart;           ///< ScatteringStepPart of all of the index
    bool coloured;             ///< channels have coefficients or phase functions of their own
    const BrickedBytes* nodes; ///< MarchMedium::SetNodes; null: `levels` are all there are
  };
  ScatteredChannels(Device& device, const Block& block);

  bool HasColour() const { return this->Channels.size() > 1; } ///< of coefficients or of the phase function

  /// Follows photons of one channel to their ends. @param in  null: this rank has no voxels
  using Follower = std::function<ScatteredPhotons(const PhotonScattering* in, PackedPhotons photons,
    const PhotonScattering::Settings& settings, const Monitor& monitor)>;
  /// Adds scattered light to the uncollided light that the same photons left.
  /// @param packed  as they were marched for that
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
