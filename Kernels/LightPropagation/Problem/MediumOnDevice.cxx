#include "LightPropagation/Problem/MediumOnDevice.h"

namespace tyndall
{
MediumOnDevice::MediumOnDevice(Device& device, const Medium& medium, const VolumeLayout& layout, const Needs& needs)
{
  const int extinctions = layout.sharedExtinction ? 1 : layout.channels;
  const auto load = [&](int channels, const char* what, auto&& value) {
    return Buffer<float>(device, Planar(layout, channels, value), what);
  };
  this->Extinction = load(extinctions, "sigma_t", [&](std::size_t i, int c) { return medium.TransportSigmaT(i, c); });
  if (needs.sigma_s)
  {
    this->Scattering =
      load(layout.channels, "sigma_s", [&](std::size_t i, int c) { return medium.TransportSigmaS(i, c); });
  }
  if (needs.sigma_a)
  {
    this->Absorption = load(layout.channels, "sigma_a", [&](std::size_t i, int c) { return medium.sigma_a.At(i, c); });
  }
}
}
