#pragma once

#include "Device/Buffer.h"
#include "Medium/Grid.h"

#include <array>

namespace tyndall
{
/// Mean free paths of the thickest voxel above which it matters where in voxels lamps' light is first scattered.
constexpr double ThickForFirstMoments = 0.1;

/// A lamp's light in thick voxels, and the sums over all lamps that it is added to. Arrays as DiffusionSystem::Arrays
/// has them.
struct LampLight
{
  std::size_t stride, firstT, first;
  const Buffer<float>* sigma_t;
  const Buffer<float>* sigma_a;
  const Buffer<float>* sigma_s;
  const Buffer<float>* swept;        ///< sigma_t of the sweeps
  const Buffer<float>* path;         ///< W length, of the lamp
  const Buffer<float>* firstMoments; ///< of it, as in Sweep/Deposit.h
  const Buffer<float>* passed;       ///< W, added to
  const Buffer<float>* allPath;      ///< W length, added to
};

/// Adds the part of a lamp's light that passes the faces of voxels at once where it is first scattered (numerics.md,
/// Eqs. (66) to (69)). One lamp at a time: each is scattered at a depth of its own in a voxel.
void PassLampLight(Device& device, const Grid& grid, const std::array<bool, 3>& periodic, const LampLight& light);
}
