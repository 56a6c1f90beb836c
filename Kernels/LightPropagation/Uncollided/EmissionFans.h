#pragma once

#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Uncollided/EmissionRaysShared.h"

#include "Device/Monitor.h"

#include <vector>

namespace tyndall
{
/// What fans of rays need.
struct FanScene
{
  const SweepVolume& volume;
  EmissionInfo info;
  const std::vector<float>& emission;    ///< of the box of what shines: [channel of the volume's][voxel], x fastest
  const Buffer<float>& emissionOnDevice; ///< the same
};

/// The light of a small bright part of the medium in voxels far from it (numerics.md, Eqs. (40a), (40b)): rays from
/// points in it go out through all of the box, and every voxel that they cross takes its share of each, so that the
/// work is that of a few rays a voxel, where rays of its own would cost each voxel all the way to what shines.
///
/// @param path, flux  as DepositEmission finds them, 0 before; flux may be empty
/// @return 1 for the voxels that have their light now; others, too near or where two halves of the fans differ too much
///   for info.uneven, have less than 1, and their path and flux count for nothing
Buffer<float> GatherByFans(
  Device& device, const FanScene& scene, const Buffer<float>& path, const Buffer<float>& flux, const Monitor& monitor);

/// Half voxels from the middle of the box of what shines, the least for a voxel to be far.
int FarFrom(const std::array<int, 3>& sourceSize);
}
