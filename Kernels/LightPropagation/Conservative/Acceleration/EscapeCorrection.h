#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Lights/Lights.h"

#include <vector>

namespace tyndall
{
/// Corrects, after each sweep of scattered light, what leaves the box: the part of a voxel's light that escapes along
/// the finer directions of the boundary's light, less that along the usual ones (numerics.md, Eq. (46)). So light that
/// is the same everywhere stays so, though it comes in along the former and is swept along the latter.
class EscapeCorrection
{
public:
  /// @param layout, scattering, sigma_t  of the medium, must stay
  /// @param fine, usual  path integrals of a sky of radiance 1 along the finer directions and the usual ones
  ///   (TransportParts::FindEvenSky), W length, [channel][stride]
  EscapeCorrection(Device& device, const VolumeLayout& layout, const TruncatedScattering& scattering,
    const Buffer<float>& sigma_t, const std::vector<float>& fine, const std::vector<float>& usual);

  /// Subtracts from the path integrals of a sweep the light that would also have escaped along the finer directions.
  /// Only scattered light is corrected: emission may come from voxels too thin to subtract from.
  /// @return W, by channel
  Rgb Apply(const Buffer<float>& path, const Buffer<float>& source);

private:
  Device& TheDevice;
  const VolumeLayout& Layout;
  const Buffer<float>& SigmaT;
  Buffer<float> Extra; ///< of a source of 1, W length
};
}
