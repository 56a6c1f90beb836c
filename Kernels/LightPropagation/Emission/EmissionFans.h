#pragma once

#include "LightPropagation/Emission/EmissionRaysShared.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include "Device/Monitor.h"

#include <array>
#include <vector>

namespace tyndall
{
/// What fans of rays need: a medium and what shines in it, of one channel.
struct FanScene
{
  const SweepVolume& volume;
  EmissionInfo info;
  std::vector<float> emission; ///< W / (length^3 sr), of the box of what shines, x fastest
};

/// What fans bring: to each voxel and through each cell of the box's faces. Only `found` ones count.
struct FanLight
{
  Buffer<float> path, flux; ///< W / length^2: mean over the voxel; flux [x, y, z][stride], may be empty
  Buffer<float> found;      ///< 1: the voxel has its light; less: it is too near, or two halves of the fans differ
  Buffer<float> faces, cellsFound; ///< the same of what leaves through the faces, W / length^2, [cell] (FanFaceFirst)
};

/// The light of a small bright part of the medium in voxels far from it (numerics.md, Eqs. (40a), (40b)): rays from
/// points in it go out through all of the box, and every voxel that they cross takes its share of each, so that the
/// work is that of a few rays a voxel, where rays of its own would cost each voxel all the way to what shines.
FanLight GatherByFans(Device& device, const FanScene& scene, const Monitor& monitor);

/// Half voxels from the middle of the box of what shines, the least for a voxel to be far.
int FarFrom(const std::array<int, 3>& sourceSize);

/// First cell of a face -x, +x, -y, +y, -z, +z; 6: all. Of a face along an axis, cells go first along the one after it.
std::size_t FanFaceFirst(const Grid& grid, int face);
}
