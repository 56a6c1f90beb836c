#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// A medium's coefficients on the device, 1/length, in the layout of VolumeLayout. sigma_t and sigma_s exclude light
/// that is treated as unscattered (TruncatedScattering.h).
class MediumOnDevice
{
public:
  /// Which coefficients get arrays of their own.
  struct Needs
  {
    bool sigma_s; ///< false if it is never read or equals sigma_t
    bool sigma_a;
  };
  MediumOnDevice(Device& device, const Medium& medium, const TruncatedScattering& scattering,
    const VolumeLayout& layout, const Needs& needs);

  const Buffer<float>& SigmaT() const { return this->Extinction; }
  const Buffer<float>& SigmaS() const { return this->Scattering.Size() > 0 ? this->Scattering : this->Extinction; }
  const Buffer<float>& SigmaA() const { return this->Absorption; } ///< empty if not requested
  /// sigma_s of each degree (TruncatedScattering.h), [degree][channel][stride]; empty if all scattering is isotropic.
  const Buffer<float>& SigmaOfDegrees() const { return this->OfDegrees; }
  /// Transport extinction sigma_a + sigma_s (1 - g), used by the diffusion correction. The same as SigmaT() if all
  /// scattering is isotropic.
  const Buffer<float>& TransportSigmaT() const
  {
    return this->Transport.Size() > 0 ? this->Transport : this->Extinction;
  }

private:
  Buffer<float> Extinction, Scattering, Absorption, OfDegrees, Transport;
};
}
