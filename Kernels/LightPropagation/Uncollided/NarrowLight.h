#pragma once

#include "LightPropagation/Uncollided/UncollidedSource.h"

namespace tyndall
{
/// Collects path integrals, and optionally net flux, of light that has one direction, or nearly one, in each voxel,
/// separately from the light of other sources. Afterwards it is added to a deposit with angular moments.
class NarrowLight
{
public:
  /// @param volume  must outlive this object; its deposit has angular moments
  /// @param withFlux  also collect net flux, for light whose direction varies from voxel to voxel
  NarrowLight(const UncollidedVolume& volume, bool withFlux);

  /// The deposit to write this light to; first moments go to those of the volume, if it has them.
  Deposit To() const;
  /// Adds the collected light to the volume's deposit, for light of direction `omega` everywhere.
  void AddAlong(const std::array<double, 3>& omega) const;
  /// Adds the collected light to the volume's deposit, with the direction of its net flux in each voxel.
  void AddAlongFlux() const;

private:
  const UncollidedVolume& Volume;
  Buffer<float> OwnPath, Flux;
};

/// Adds light to an array with angular moments; its direction in each voxel is that of its net flux.
/// @param path, flux  W length, or another unit: [channel][stride], [channel][x, y, z][stride]
/// @param peak  1: moments of a single direction, or of one that spreads diffusively about its mean; below 1: moments
///   above degree 1 are reduced, see SmoothPeak()
void AddNarrowMoments(Device& device, const VolumeLayout& layout, const AngularBasis& basis, const Buffer<float>& path,
  const Buffer<float>& flux, const Buffer<float>& moments, float peak = 1.0f);
}
