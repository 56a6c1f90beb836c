#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// A medium's coefficients as kernels read them, 1/length, laid out as VolumeLayout says. Scattering with a mean cosine
/// g is isotropic scattering of sigma_s (1 - g) (numerics.md, Eq. (8)).
class MediumOnDevice
{
public:
  /// Which coefficients get arrays of their own.
  struct Needs
  {
    bool sigma_s; ///< false where it is never read, or equals sigma_t
    bool sigma_a;
  };
  MediumOnDevice(Device& device, const Medium& medium, const VolumeLayout& layout, const Needs& needs);

  const Buffer<float>& SigmaT() const { return this->Extinction; }
  const Buffer<float>& SigmaS() const { return this->Scattering.Size() > 0 ? this->Scattering : this->Extinction; }
  const Buffer<float>& SigmaA() const { return this->Absorption; } ///< empty where it was not asked for

private:
  Buffer<float> Extinction, Scattering, Absorption;
};
}
