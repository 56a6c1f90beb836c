#pragma once

#include "LightPropagation/Uncollided/UncollidedSource.h"

namespace tyndall
{
/// Path integrals, and net flux, of light that goes one way in each voxel, or nearly so, gathered apart from that of
/// other sources, to be added to a deposit with angular moments.
class NarrowLight
{
public:
  /// @param volume  must stay; its deposit has angular moments
  /// @param withFlux  the light's direction varies by voxel
  NarrowLight(const UncollidedVolume& volume, bool withFlux);

  /// Where the light is to be put down; first moments go where the volume has them.
  Deposit To() const;
  /// Adds what was put down to the volume's deposit: of light that goes the same way everywhere;
  void AddAlong(const std::array<double, 3>& omega) const;
  /// of light whose net flux tells which way it goes.
  void AddAlongFlux() const;

private:
  const UncollidedVolume& Volume;
  Buffer<float> OwnPath, Flux;
};

/// Adds light whose net flux tells which way it goes to an array with angular moments.
/// @param path, flux  W length, or another unit: [channel][stride], [channel][x, y, z][stride]
/// @param peak  1: moments of light that goes one way, or spreads about it as heat does; less: those above the first
///   smaller, as SmoothPeak has it
void AddNarrowMoments(Device& device, const VolumeLayout& layout, const AngularBasis& basis, const Buffer<float>& path,
  const Buffer<float>& flux, const Buffer<float>& moments, float peak = 1.0f);
}
