#pragma once

#include "Device/Buffer.h"
#include "Medium/Grid.h"

#include <array>

namespace tyndall
{
/// Optical thickness of the thickest voxel above which the position of first scattering within voxels is taken into
/// account.
constexpr double ThickForFirstMoments = 0.1;

/// Uncollided light of one lamp and the coefficients of the medium, and the sums over all lamps that PassLampLight()
/// adds to. Arrays are [channel][voxel], `stride` floats per channel; firstMoments and passed are
/// [channel][face][voxel].
struct LampLight
{
  std::size_t stride, firstT, first;
  const Buffer<float>* sigma_t;
  const Buffer<float>* sigma_a;
  const Buffer<float>* sigma_s;
  const Buffer<float>* swept; ///< extinction that sweeps use, 1/length
  const Buffer<float>* path;  ///< path integrals of the lamp, W length
  /// First moments of the lamp's deposit: where in each voxel its light collides first (Deposit::firstMoments), W
  /// length
  const Buffer<float>* firstMoments;
  /// Power of first-scattered light through voxel faces, W, to which PassLampLight() adds.
  const Buffer<float>* passed;
  const Buffer<float>* allPath; ///< path integrals of all lamps, W length, to which PassLampLight() adds `path`
};

/// Adds the power of a lamp's first-scattered light that leaves its voxel through each face without another collision
/// (numerics.md, Eqs. (66) to (69)). To be called for each lamp, since the depth of first scattering in a voxel depends
/// on the lamp.
void PassLampLight(Device& device, const Grid& grid, const std::array<bool, 3>& periodic, const LampLight& light);
}
