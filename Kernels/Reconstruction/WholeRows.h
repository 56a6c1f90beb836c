#pragma once

#include "Device/HostMappedBuffer.h"
#include "Reconstruction/LightRows.h"

namespace tyndall
{
/// An array over voxels whose rows are whole vectors: the host's own where it has such rows, else a copy with longer
/// ones that repeat the last voxel.
class WholeRows
{
public:
  /// @param array    over `volumes` grids of `size` voxels, x fastest, `components` per voxel; must outlive this
  /// @param written  kernels write it: Fetch() when they are done. Else they read it.
  WholeRows(const RowKernels& kernels, const HostMappedBuffer<float>& array, const std::array<int, 3>& size,
    int volumes, int components, bool written, const char* what);

  const cl::Buffer& Handle() const { return this->Wide.Size() > 0 ? this->Wide.Handle() : this->Own.Handle(); }

  /// Wait for the device; then the host's array holds what kernels wrote.
  void Fetch() const;

private:
  void Copy(const cl::Buffer& from, int fromRow, const cl::Buffer& to, int toRow) const;

  const RowKernels& Kernels;
  const HostMappedBuffer<float>& Own;
  int Voxels, Components;
  std::size_t Rows;
  int Pitch;
  Buffer<float> Wide;
};

/// The layout of a grid's voxels in such rows, as kernels take it.
inline cl_int4 VoxelLayout(const std::array<int, 3>& size, int width)
{
  return { { size[0], size[1], size[2], WholeVectors(size[0], width) } };
}
}
