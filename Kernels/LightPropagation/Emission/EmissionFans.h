#pragma once

#include "LightPropagation/Emission/EmissionRaysShared.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include "Device/Monitor.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Scene for GatherByFans(): a medium and its localised emission, in one channel.
struct FanScene
{
  const SweepVolume& volume;
  EmissionInfo info;
  std::vector<float> emission; ///< emission in the emitting box, W / (length^3 sr), x fastest
};

/// Result of GatherByFans(): light of a localised emission in each voxel and through each cell of the box's faces.
/// Values are valid only where `found` (voxels) or `cellsFound` (cells) is 1.
struct FanLight
{
  /// Mean fluence and net flux of each voxel, W / length^2; flux is [x, y, z][voxel], empty if not requested
  Buffer<float> path, flux;
  /// For each voxel, 1: its value is accurate; 0: it is not, since the light of one half of the traced rays differs
  /// from that of the other half; -1: the voxel is too close to the emission.
  Buffer<float> found;
  /// For each cell of the box's faces, numbered face by face (FanFaceFirst()): outgoing flux density, W / length^2, and
  /// 1 where it is accurate.
  Buffer<float> faces, cellsFound;
};

/// Computes the light of a localised emission in voxels far from it (numerics.md, Eqs. (40a), (40b)). Rays from points
/// in the emitting box cross the whole grid, and every voxel that a ray crosses uses it. The cost is that of a few rays
/// per voxel, whereas rays traced for each voxel separately would all have to cross the grid to the emission.
FanLight GatherByFans(Device& device, const FanScene& scene, const Monitor& monitor);

/// Minimum distance, in half voxels along an axis, between the centre of the emitting box and a voxel that uses fans of
/// rays.
/// @param sourceSize  size of the emitting box, voxels
int FarFrom(const std::array<int, 3>& sourceSize);

/// Index of the first cell of face `face` (order -x, +x, -y, +y, -z, +z) among the cells of all faces of the grid; the
/// number of all cells if `face` is 6. In a face across axis a, cells along axis a + 1 are contiguous.
std::size_t FanFaceFirst(const Grid& grid, int face);
}
