#pragma once

#include "Device/Monitor.h"
#include "Refraction/Voxelization/SampleLattice.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// Where a mesh winds about samples neither 0 times nor once: it intersects itself, or has parts inside out or within
/// each other.
struct WindingNumbers
{
  std::size_t oddSamples = 0;                         ///< samples about which it does so
  int lowest = 0, highest = 1;                        ///< how often it winds about them and others
  std::array<double, 3> firstOddSample = { 0, 0, 0 }; ///< where the first is, in the order z, y, x for columns along x
};

/// Winding numbers about the samples of some rows of voxels.
/// @param rows      of voxels along columns.up: not 0 where they are looked at
/// @param inverted  whether the corners run clockwise seen from outside
WindingNumbers FindWindings(Device& device, const Grid& grid, const LatticeMesh& mesh, const SampleColumns& columns,
  const std::vector<cl_int>& rows, bool inverted, const Monitor& monitor = {});
}
