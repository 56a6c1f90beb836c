#pragma once

#include "Device/Device.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Scattering/ScatteringOperator.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

namespace tyndall
{
/// Isotropic scattering: source = sigma_s fluence / 4 pi (numerics.md, Eq. (42); Gruson et al. 2012, equation 4, in
/// conservative form). sigma_s already includes the factor for a mean cosine g (TruncatedScattering.h).
class IsotropicScattering : public ScatteringOperator
{
public:
  /// @param medium  coefficients on the device; must outlive this object
  /// @param scatters  false: sigma_s is zero everywhere, and no source is written
  IsotropicScattering(Device& device, const VolumeLayout& layout, const MediumOnDevice& medium, bool scatters);

  Powers ScatterOrder(const Deposit& swept, const Buffer<float>& fluence, const Buffer<float>& source,
    const std::array<std::size_t, 2>& range) const override;
  bool CanScatterAllOrders() const override { return true; }
  void ScatterAllOrders(const Buffer<float>& fluence, const Buffer<float>& source) const override;
  void AddFirstScattered(const Deposit& uncollided, const Buffer<float>& source) const override;
  /// Nothing to add: isotropic scattering has no separate source of beams.
  void AddBeam(const Buffer<float>&, const Buffer<float>&, int) const override {}
  void ScatterFluence(int channel, const Deposit& swept, const ExactValues& fluence, const Buffer<float>& given,
    const Buffer<float>& source) const override;

private:
  cl::Kernel Kernel(const char* name) const;
  cl::NDRange Values() const { return cl::NDRange(this->Layout.Stride(), this->Layout.channels); }
  float PerVolume() const { return static_cast<float>(1.0 / this->Layout.grid.VoxelVolume()); }

  Device& TheDevice;
  VolumeLayout Layout;
  const MediumOnDevice& TheMedium;
  bool Scatters;
};
}
