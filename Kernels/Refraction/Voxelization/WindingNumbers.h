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
/// Compiler options of Voxelization.cl.
std::string CrossingOptions(int samplesOfVoxel, bool winding);

/// Marks the crossings of meshes with some rows of columns in a buffer (mark_crossings of Voxelization.cl).
class CrossingMarker
{
public:
  /// @param words      32-bit words per column
  /// @param fromAbove  mark the samples after a crossing instead of those before it
  CrossingMarker(Device& device, const SampleColumns& columns, int words, bool fromAbove, const std::string& options);

  /// Queues the kernel.
  /// @param marks  cleared by the caller; `words` for each column of the rows
  /// @param sums   cleared by the caller; one for each column of the rows; empty if winding numbers are computed
  void Mark(const LatticeMesh& mesh, int firstRow, int endRow, Buffer<cl_uint>& marks, Buffer<cl_uint>& sums);

private:
  Device& TheDevice;
  SampleColumns Columns;
  int Words;
  bool FromAbove;
  cl::Kernel Kernel;
  Buffer<cl_uint4> Tiles;
};

/// Work-group size of the kernels of Voxelization.cl, which have one work-item per tile or column.
inline cl::NDRange CrossingGroup()
{
  return cl::NDRange(64);
}
cl::NDRange CrossingRange(std::size_t items);

/// Samples at which the winding number of a mesh is neither 0 nor 1: the mesh intersects itself, or has parts inside
/// out or within each other.
struct WindingNumbers
{
  std::size_t oddSamples = 0;  ///< number of such samples
  int lowest = 0, highest = 1; ///< range of their winding numbers, and of 0 and 1
  /// Position of the first such sample, in the order z, y, x for columns along x.
  std::array<double, 3> firstOddSample = { 0, 0, 0 };
  std::array<int, 3> firstOddNumber = { 0, 0, 0 }; ///< its index along each axis of the whole grid

  /// Adds the results for other samples, with columns along x.
  void Add(const WindingNumbers& others);
};

/// Computes winding numbers at the samples in some rows of voxels of a box of the grid.
/// @param mesh      on the lattice that starts at the box's first voxel, as do the columns
/// @param rows      one per row of voxels along columns.up: nonzero to examine the row
/// @param inverted  whether the corners run clockwise as seen from outside
WindingNumbers FindWindings(Device& device, const Grid& grid, const VoxelBox& box, const LatticeMesh& mesh,
  const SampleColumns& columns, const std::vector<cl_int>& rows, bool inverted, const Monitor& monitor = {});
}
