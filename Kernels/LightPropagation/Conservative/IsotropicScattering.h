#pragma once

#include "Device/Device.h"
#include "LightPropagation/Conservative/MediumOnDevice.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>

namespace tyndall
{
/// The scattering operator of isotropic scattering: from the path integrals that a sweep left to fluence and to the
/// next source, sigma_s fluence / 4 pi (numerics.md, Eq. (42); Gruson et al. 2012, equation 4, conservative).
class IsotropicScattering
{
public:
  /// @param medium  must stay
  /// @param scatters  false: sigma_s is zero everywhere, and there is no source to write
  IsotropicScattering(Device& device, const VolumeLayout& layout, const MediumOnDevice& medium, bool scatters);

  /// W, by channel.
  struct Powers
  {
    Rgb absorbed = {}, scattered = {};
  };

  /// Takes what a sweep left: clears `path`, adds it to `fluence`, writes `source`. All [channel][stride].
  /// @param range  values of a channel that the sweep may have changed, whole vectors
  Powers Scatter(const Buffer<float>& path, const Buffer<float>& fluence, const Buffer<float>& source,
    const std::array<std::size_t, 2>& range) const;

  /// The source of all orders at once from the fluence of all, less what the last one left over, which `source` holds
  /// (numerics.md, Eq. (44)).
  void SourceOfAll(const Buffer<float>& fluence, const Buffer<float>& source) const;

  /// Adds to fluence what a sweep left in the voxels outside a box.
  void AddOutside(const VoxelBox& box, const Buffer<float>& path, const Buffer<float>& fluence) const;

private:
  cl::Kernel Kernel(const char* name) const;

  Device& TheDevice;
  VolumeLayout Layout;
  const MediumOnDevice& TheMedium;
  bool Scatters;
};
}
