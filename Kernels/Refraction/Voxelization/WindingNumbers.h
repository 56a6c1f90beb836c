#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Medium/VoxelBox.h"
#include "Refraction/Voxelization/SampleLattice.h"

#include <cstddef>
#include <string>
#include <vector>

namespace tyndall
{
/// Options of Voxelization.cl.
std::string CrossingOptions(int samplesOfVoxel, bool winding);

/// Puts the crossings of meshes with some rows of columns into a buffer (mark_crossings of Voxelization.cl).
class CrossingMarker
{
public:
  /// @param words      of 32 bits in a column
  /// @param fromAbove  what lies after a crossing is marked, in place of what lies before
  CrossingMarker(Device& device, const SampleColumns& columns, int words, bool fromAbove, const std::string& options);

  /// Queues the kernel.
  /// @param marks  cleared before; `words` for each column of the rows
  /// @param sums   cleared before; one for each column of the rows; empty where windings are asked for
  void Mark(const LatticeMesh& mesh, int firstRow, int endRow, Buffer<cl_uint>& marks, Buffer<cl_uint>& sums);

private:
  Device& TheDevice;
  SampleColumns Columns;
  int Words;
  bool FromAbove;
  cl::Kernel Kernel;
  Buffer<cl_uint4> Tiles;
};

/// How the kernels of Voxelization.cl run: a work-item per tile or column.
inline cl::NDRange CrossingGroup()
{
  return cl::NDRange(64);
}
cl::NDRange CrossingRange(std::size_t items);

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
