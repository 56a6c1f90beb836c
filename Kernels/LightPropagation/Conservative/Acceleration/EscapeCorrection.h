#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Lights/Lights.h"

#include <vector>

namespace tyndall
{
/// Corrects the escaped power after each sweep of scattered light: adds, for each voxel, the power that escapes along
/// the finer quadrature of the boundary light minus that along the usual quadrature (numerics.md, Eq. (46)). A uniform
/// radiance field then stays uniform, although boundary light enters along the finer quadrature and is swept along the
/// usual one.
class EscapeCorrection
{
public:
  /// @param layout, scattering, sigma_t  of the medium, must outlive this
  /// @param fine, usual  path integrals of a sky of radiance 1 along the finer and the usual quadrature
  ///   (TransportParts::FindEvenSky), W length, [channel][stride]
  EscapeCorrection(Device& device, const VolumeLayout& layout, const TruncatedScattering& scattering,
    const Buffer<float>& sigma_t, const std::vector<float>& fine, const std::vector<float>& usual);

  /// Subtracts the additional escaped power from the path integrals of a sweep. Only scattered light is corrected,
  /// because emission may come from voxels too thin to subtract from.
  /// @return the additional escaped power by channel, W
  Rgb Apply(const Buffer<float>& path, const Buffer<float>& source);

private:
  Device& TheDevice;
  const VolumeLayout& Layout;
  const Buffer<float>& SigmaT;
  Buffer<float> Extra; ///< additional escape of a source of 1, W length
};
}
