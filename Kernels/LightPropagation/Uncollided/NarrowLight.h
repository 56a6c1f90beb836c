#pragma once

#include "LightPropagation/Uncollided/UncollidedSource.h"

namespace tyndall
{
/// Collector of the light, such as that of lamps, that has a single direction, or nearly one, in each voxel: path
/// integrals, and optionally net flux, separate from the light of other sources. Afterwards they are added to a deposit
/// with angular moments.
class NarrowLight
{
public:
  /// @param volume  must outlive this object; its deposit has angular moments
  /// @param withFlux  whether to collect net flux too, for light whose direction varies from voxel to voxel
  NarrowLight(const UncollidedVolume& volume, bool withFlux);

  /// Deposit that receives the light to be collected; its first moments are those of the volume's deposit, if that has
  /// them.
  Deposit To() const;
  /// Adds the collected light, of direction `omega` in all voxels, to the volume's deposit.
  void AddAlong(const std::array<double, 3>& omega) const;
  /// Adds the collected light, in each voxel along its net flux, to the volume's deposit.
  void AddAlongFlux() const;

private:
  const UncollidedVolume& Volume;
  Buffer<float> OwnPath, Flux;
};

/// Adds light along its net flux in each voxel to an array with angular moments.
/// @param path, flux  W length, or another unit: [channel][voxel], [channel][x, y, z][voxel]
/// @param peak  1: moments of a single direction, or of one that spreads diffusively about its mean; below 1: moments
/// above degree 1 are reduced, see SmoothPeak()
void AddNarrowMoments(Device& device, const VolumeLayout& layout, const AngularBasis& basis, const Buffer<float>& path,
  const Buffer<float>& flux, const Buffer<float>& moments, float peak = 1.0f);
}
