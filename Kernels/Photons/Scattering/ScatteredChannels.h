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
  /// @param through  as photons march through the medium; must stay
  /// @param medium, ior, levels  as PhotonMarcher has them; read here only
  ScatteredChannels(
    Device& device, const MarchMedium& through, const Medium& medium, const Field& ior, const std::uint8_t* levels);
  /// Of a block of a grid.
  struct Block
  {
    const MarchMedium* through; ///< must stay; null: without voxels
    const Medium& medium;       ///< looked at by nobody then
    Field ior;                  ///< of the voxels whose index the block knows
    // Of all blocks alike.
    const MarchSettings& settings;
    double stepPart;                     ///< ScatteringStepPart of all of the index
    bool coloured;                       ///< channels have coefficients or phase functions of their own
    const BrickedBytes* nodes = nullptr; ///< MarchMedium::SetNodes; null: there is no octree
  };
  ScatteredChannels(Device& device, const Block& block);

  bool HasColour() const { return this->Channels.size() > 1; } ///< of coefficients or of the phase function

  /// Follows photons of one channel. @param in  null: through a block without voxels
  using Follower = std::function<ScatteredPhotons(const PhotonScattering* in, PackedPhotons photons,
    const PhotonScattering::Settings& settings, const Monitor& monitor)>;
  /// Adds scattered light to the uncollided light that the same photons left.
  /// @param packed  as they were marched for that
  void AddTo(PhotonLight& light, const PackedPhotons& packed, const PhotonNumbers& numbers, const Monitor& monitor,
    const Follower& follow = FollowToTheEnd) const;

private:
  static ScatteredPhotons FollowToTheEnd(const PhotonScattering* in, PackedPhotons photons,
    const PhotonScattering::Settings& settings, const Monitor& monitor);

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
