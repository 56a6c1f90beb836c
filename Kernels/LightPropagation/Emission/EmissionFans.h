#pragma once

#include "LightPropagation/Emission/EmissionRaysShared.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include "Device/Monitor.h"

#include <array>
#include <vector>

namespace tyndall
{
/// The medium and its localised emission in one channel, as the fans of rays need them.
struct FanScene
{
  const SweepVolume& volume;
  EmissionInfo info;
  std::vector<float> emission; ///< W / (length^3 sr), over the emitting box, x fastest
};

/// The light that fans carry to each voxel and through each cell of the box's faces. Values are valid only where
/// `found` is 1.
struct FanLight
{
  Buffer<float> path, flux; ///< W / length^2: mean over the voxel; flux is [x, y, z][stride], may be empty
  /// 1: the voxel's value is accurate; less: it is too close to the emission, or the two halves of the fans differ
  Buffer<float> found;
  /// Outgoing flux density through the faces, W / length^2, and whether it is accurate; [cell] (FanFaceFirst).
  Buffer<float> faces, cellsFound;
};

/// The light of a localised emission in voxels far from it (numerics.md, Eqs. (40a), (40b)). Rays from points in the
/// emitting box cross the whole grid, and every voxel on their way uses each of them. The cost is that of a few rays a
/// voxel, whereas rays traced for each voxel separately would all have to cross the grid to the emission.
FanLight GatherByFans(Device& device, const FanScene& scene, const Monitor& monitor);

/// Minimum distance, in half voxels, from the centre of the emitting box along an axis for a voxel to count as far.
int FarFrom(const std::array<int, 3>& sourceSize);

/// Index of the first cell of a face in the order -x, +x, -y, +y, -z, +z; for 6 the number of all cells. Within a face
/// along axis a the cells along axis a + 1 are contiguous.
std::size_t FanFaceFirst(const Grid& grid, int face);
}
