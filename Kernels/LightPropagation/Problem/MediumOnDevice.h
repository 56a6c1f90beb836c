#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// A medium's coefficients as kernels read them, 1/length, laid out as VolumeLayout says: sigma_t and sigma_s without
/// what is scattered straight on (TruncatedScattering.h).
class MediumOnDevice
{
public:
  /// Which coefficients get arrays of their own.
  struct Needs
  {
    bool sigma_s; ///< false where it is never read, or equals sigma_t
    bool sigma_a;
  };
  MediumOnDevice(Device& device, const Medium& medium, const TruncatedScattering& scattering,
    const VolumeLayout& layout, const Needs& needs);

  const Buffer<float>& SigmaT() const { return this->Extinction; }
  const Buffer<float>& SigmaS() const { return this->Scattering.Size() > 0 ? this->Scattering : this->Extinction; }
  const Buffer<float>& SigmaA() const { return this->Absorption; } ///< empty where it was not asked for
  /// sigma_s of each degree (TruncatedScattering.h), [degree][channel][stride]; empty where all is isotropic.
  const Buffer<float>& SigmaOfDegrees() const { return this->OfDegrees; }
  /// sigma_a and sigma_s (1 - g): what light diffuses with. As SigmaT() where all is isotropic.
  const Buffer<float>& TransportSigmaT() const
  {
    return this->Transport.Size() > 0 ? this->Transport : this->Extinction;
  }

private:
  Buffer<float> Extinction, Scattering, Absorption, OfDegrees, Transport;
};
}
