#pragma once

#include "Device/Buffer.h"
#include "Refraction/Voxelization/SampleLattice.h"

#include <array>

namespace tyndall
{
/// Rows of voxels along an axis, and the samples of a mesh about them.
struct SampleSlab
{
  int firstVoxel, endVoxel; ///< along columns.up
  int firstRow, endRow;     ///< of samples: those of the voxels, and one on either side where the grid has it
};

/// Counts samples of voxels to a fraction of a sample, from where exactly the surface lies between two of them
/// (numerics.md, section 11.1). Occupancy by samples alone has terraces where a surface is nearly parallel to layers of
/// voxels, wider than the index's smoothing: they bend light.
class SurfaceFraction
{
public:
  /// @param columns  of the samples' bits, `words` of 32 per column
  /// @param voxels   of a slab, at most: takes 4 bytes each, and 4 more where there are several meshes
  SurfaceFraction(
    Device& device, const Grid& grid, const SampleColumns& columns, int words, std::size_t voxels, bool several);

  /// Before the last mesh of a slab.
  void Begin();

  /// Queues the measurement of what counting samples leaves out of a mesh.
  /// @param orientation  see OrientedMesh
  /// @param bits         samples in the mesh, of the slab's rows
  /// @param claimed      samples in later meshes, of the same rows; empty where there is but one mesh
  void Measure(const LatticeMesh& mesh, int orientation, const SampleSlab& slab, const Buffer<cl_uint>& bits,
    const Buffer<cl_uint>& claimed);

  /// Queues the conversion of the slab's counts from whole samples to units of 1 / UnitsOfSample, with what was
  /// measured of the last mesh. Claims the samples of the slab's rows that are not of its voxels.
  void Refine(const SampleSlab& slab, const Buffer<cl_uint>& bits, Buffer<cl_uint>& claimed, Buffer<cl_ushort>& counts);

private:
  void Claim(const SampleSlab& slab, int row, const Buffer<cl_uint>& bits, Buffer<cl_uint>& claimed);
  cl_int4 VoxelsOf(const SampleSlab& slab) const;

  Device& TheDevice;
  std::array<int, 3> Size; ///< of the grid
  SampleColumns Bits;
  int Words;
  bool Several;
  std::array<SampleColumns, 3> Columns; ///< along x, y and z
  std::array<cl::Kernel, 3> MeasureAlong;
  cl::Kernel RefineCounts, ClaimSamples;
  std::array<Buffer<cl_uint4>, 3> Tiles;
  Buffer<cl_int> Corrections;
  Buffer<cl_ushort2> Taken;
};
}
