#include "LightPropagation/Problem/MediumOnDevice.h"

namespace tyndall
{
MediumOnDevice::MediumOnDevice(Device& device, const Medium& medium, const TruncatedScattering& scattering,
  const VolumeLayout& layout, const Needs& needs)
{
  const int extinctions = layout.sharedExtinction ? 1 : layout.channels;
  const auto load = [&](int channels, const char* what, auto&& value) {
    return PlanarOnDevice(device, layout, channels, value, what);
  };
  this->Extinction = load(extinctions, "sigma_t", [&](std::size_t i, int c) { return scattering.SigmaT(i, c); });
  if (needs.sigma_s)
  {
    this->Scattering = load(layout.channels, "sigma_s", [&](std::size_t i, int c) { return scattering.SigmaS(i, c); });
  }
  if (needs.sigma_a)
  {
    this->Absorption = load(layout.channels, "sigma_a", [&](std::size_t i, int c) { return medium.sigma_a.At(i, c); });
  }
  if (scattering.Degree() > 0)
  {
    this->OfDegrees = load(layout.channels * (scattering.Degree() + 1), "sigma_s",
      [&](std::size_t i, int part) { return scattering.SigmaS(i, part % layout.channels, part / layout.channels); });
    this->Transport = load(extinctions, "sigma_t", [&](std::size_t i, int c) { return medium.TransportSigmaT(i, c); });
  }
}
}
