#pragma once

#include "Device/Buffer.h"
#include "Medium/Grid.h"

#include <array>

namespace tyndall
{
/// Optical thickness of the thickest voxel above which the position of first scattering within voxels matters.
constexpr double ThickForFirstMoments = 0.1;

/// A lamp's light in optically thick voxels, and the sums over all lamps to which it is added. Arrays as in
/// DiffusionSystem::Arrays.
struct LampLight
{
  std::size_t stride, firstT, first;
  const Buffer<float>* sigma_t;
  const Buffer<float>* sigma_a;
  const Buffer<float>* sigma_s;
  const Buffer<float>* swept;        ///< sigma_t of the sweeps
  const Buffer<float>* path;         ///< W length, of the lamp
  const Buffer<float>* firstMoments; ///< first moments of the lamp's deposit, as in Sweep/SweepOperator.h
  const Buffer<float>* passed;       ///< W, added to
  const Buffer<float>* allPath;      ///< W length, added to
};

/// Adds the part of a lamp's light that crosses the faces of voxels directly after its first scattering (numerics.md,
/// Eqs. (66) to (69)). Must be called for one lamp at a time, since the depth of first scattering in a voxel depends on
/// the lamp.
void PassLampLight(Device& device, const Grid& grid, const std::array<bool, 3>& periodic, const LampLight& light);
}
