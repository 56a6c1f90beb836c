#pragma once

#include "Device/Buffer.h"
#include "Refraction/Voxelization/SampleLattice.h"

#include <string>

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
}
