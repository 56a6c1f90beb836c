#pragma once

#include "Device/Monitor.h"
#include "Medium/VoxelBox.h"
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
  std::array<int, 3> firstOddNumber = { 0, 0, 0 };    ///< its number along each axis of the whole grid

  /// Of samples apart from these, too, for columns along x.
  void Add(const WindingNumbers& others);
};

/// Winding numbers about the samples of some rows of voxels of a box of the grid.
/// @param mesh      on the lattice from the box's first voxel on, as columns are
/// @param rows      of voxels along columns.up: not 0 where they are looked at
/// @param inverted  whether the corners run clockwise seen from outside
WindingNumbers FindWindings(Device& device, const Grid& grid, const VoxelBox& box, const LatticeMesh& mesh,
  const SampleColumns& columns, const std::vector<cl_int>& rows, bool inverted, const Monitor& monitor = {});
}
