#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Lights/Lights.h"

#include <vector>

namespace tyndall
{
/// Corrects the escaped power after each sweep of scattered light (numerics.md, Eq. (46)). For each voxel it adds the
/// power that would escape along the finer quadrature of the boundary light, and subtracts the power that escapes along
/// the quadrature of scattered light. A uniform radiance field then stays uniform, although boundary light enters along
/// the finer quadrature and scattered light is swept along its own.
class EscapeCorrection
{
public:
  /// @param layout, scattering, sigma_t  layout and coefficients of the medium; must outlive this object
  /// @param fine, usual  path integrals of the uncollided light of a sky of radiance 1 (TransportParts::FindEvenSky),
  ///   swept along the finer quadrature and along that of scattered light, W length, [channel][voxel]
  EscapeCorrection(Device& device, const VolumeLayout& layout, const TruncatedScattering& scattering,
    const Buffer<float>& sigma_t, const std::vector<float>& fine, const std::vector<float>& usual);

  /// Subtracts the additional escaped power of scattered light from the path integrals of a sweep. Emission is not
  /// corrected, because emitting voxels may be so thin that the correction exceeds their path integral.
  /// @param path  path integrals of the sweep, W length; changed
  /// @param source  scattering source of the sweep, W / (length^3 sr)
  /// @return the additional escaped power by channel, W
  Rgb Apply(const Buffer<float>& path, const Buffer<float>& source);

private:
  Device& TheDevice;
  const VolumeLayout& Layout;
  const Buffer<float>& SigmaT;
  /// Additional escaped power of each voxel for a source of 1 W / (length^3 sr), divided by sigma_t: W length,
  /// [channel][voxel].
  Buffer<float> Extra;
};
}
