#pragma once

#include "Photons/Scattering/PhotonScattering.h"

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

  bool HasColour() const { return this->Channels.size() > 1; } ///< of coefficients or of the phase function

  /// Adds scattered light to the uncollided light that the same photons left.
  /// @param packed  as they were marched for that
  void AddTo(PhotonLight& light, const PackedPhotons& packed, const PhotonNumbers& numbers, const Monitor& monitor);

private:
  struct Channel
  {
    std::unique_ptr<const MarchMedium> own; ///< of one channel of a coloured medium
    std::unique_ptr<PhotonScattering> photons;
  };
  static Rgb ColourOfRun(const PackedPhotons& packed, bool oneRun, int run);

  const MarchMedium& Through;
  std::vector<Channel> Channels;
};
}
