#pragma once

#include "LightPropagation/Uncollided/UncollidedSource.h"

namespace tyndall
{
/// Collects light that has a single direction, or nearly one, in each voxel, such as the light of lamps. Its path
/// integrals, and optionally its net flux, are first summed separately from other light, and then added with their
/// angular moments to a deposit.
class NarrowLight
{
public:
  /// @param volume  must outlive this object; its deposit has angular moments
  /// @param withFlux  whether to collect net flux too, for light whose direction varies from voxel to voxel
  NarrowLight(const UncollidedVolume& volume, bool withFlux);

  /// Deposit that receives the light to be collected. Its array of first moments is that of the volume's deposit, if
  /// there is one.
  Deposit To() const;
  /// Adds the collected light to the volume's deposit. Its direction is `omega` in all voxels.
  void AddAlong(const std::array<double, 3>& omega) const;
  /// Adds the collected light to the volume's deposit. Its direction in each voxel is that of its net flux.
  void AddAlongFlux() const;

private:
  const UncollidedVolume& Volume;
  Buffer<float> OwnPath, Flux;
};

/// Adds light to an array with angular moments. The direction of the light in each voxel is that of its net flux.
/// @param path, flux  W length, or another unit: [channel][voxel], [channel][x, y, z][voxel]
/// @param peak  1: moments of a single direction, or of one that spreads diffusively about its mean; below 1: moments
/// above degree 1 are reduced, see SmoothPeak()
void AddNarrowMoments(Device& device, const VolumeLayout& layout, const AngularBasis& basis, const Buffer<float>& path,
  const Buffer<float>& flux, const Buffer<float>& moments, float peak = 1.0f);
}
