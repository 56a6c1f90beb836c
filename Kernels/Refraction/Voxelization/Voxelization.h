#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"
#include "Refraction/Voxelization/SampleLattice.h"
#include "Refraction/Voxelization/TriangleMesh.h"
#include "Refraction/Voxelization/WindingNumbers.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

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

struct VoxelizationSettings
{
  int samples = 4; ///< fine voxels per edge of a voxel, 1 to 16

  /// Whether counts tell of fractions of samples, from where the surface lies between them. Else occupancy comes in
  /// steps of 1 / samples^3, as published.
  bool fractions = true;

  /// Which way the columns run: along axis 0, 1 or 2, toggling what lies before a crossing or, from above, what lies
  /// after it. It makes no difference to the result, to the last bit.
  int columnAxis = 0;
  bool fromAbove = false;

  /// Bytes of the fine grid, a bit a sample, that are there at a time: a slab of voxels, of one layer at least.
  std::size_t slabBytes = std::size_t(16) << 20;
};

/// Counts are in parts of a sample: so many of them are one.
constexpr int UnitsOfSample(int samples)
{
  return 65535 / (samples * samples * samples);
}

/// @throws InvalidInput
void Check(const VoxelizationSettings& settings);

/// A closed mesh, and how its corners run.
struct OrientedMesh
{
  /// Closed, or closed when rounded; see Examine. A triangle without area does nothing.
  const TriangleMesh* mesh = nullptr;
  int orientation = 1; ///< 1: counterclockwise seen from outside; -1: clockwise; 0: its triangles disagree
};

/// Samples of the voxels of a slab that lie in one of several meshes.
struct SamplesInside
{
  std::size_t mesh; ///< number of the mesh
  /// A voxel 0 to samples^3 UnitsOfSample(samples), x fastest. Written again for the next mesh.
  const Buffer<cl_ushort>& counts;

  /// The slab's voxels are `runs` runs of `length` of the box's: the first begins at voxel `first`, the next `stride`
  /// later.
  std::size_t first, length, stride, runs;
  std::size_t VoxelCount() const { return this->length * this->runs; }
};

/// The part of a grid that is voxelised.
struct CountedVoxels
{
  VoxelBox box; ///< whose samples are counted
  VoxelBox own; ///< in it, those that winding numbers are of

  static CountedVoxels All(const Grid& grid) { return { { {}, grid.size }, { {}, grid.size } }; }
};

/// Number of samples of each voxel that lie in each of several closed meshes. Where meshes overlap, the last of them
/// has the samples.
///
/// The bit-slice voxelisation of Eisemann and Decoret (Single-pass GPU solid voxelization for real-time applications,
/// Graphics Interface 2008; Pfeuti 2009, section 3.1.2): a column of samples is a row of bits, and every triangle
/// toggles those that lie before it. Samples are the centres of fine voxels. Points of the mesh are rounded to a
/// lattice a millionth of the box wide (SampleLattice), and from there on everything is exact: a column through an edge
/// or a corner is counted once, a closed mesh never leaks, and a sample is inside or not whichever way its column runs.
/// Then fractions of samples are added or taken away by where the surface crosses columns along x, y and z
/// (SurfaceFraction); a voxel through which no surface goes is all inside or all outside.
///
/// What is found of a voxel does not depend on which box of the grid is asked for, to the last bit, but for the
/// outermost voxels of a box that ends within the grid: of what is thinner than a sample there, the sample beyond it
/// would have told on which side it lies.
///
/// @param take  handed what is found slab by slab, and of each slab mesh by mesh from the last to the first, so that
///   what is on the device at a time does not grow with the grid or the number of meshes
/// @return a mesh: whether it winds about all samples 0 times or once. Where it does not the samples inside are those
///   about which it winds an odd number of times. Not known where the orientation is 0: the numbers are those of a
///   closed mesh that is well oriented
/// @throws InvalidInput   where a setting or a mesh's size has no meaning
/// @throws DeviceError    if the meshes and a slab do not fit the device
std::vector<WindingNumbers> CountSamplesInside(Device& device, const Grid& grid, const CountedVoxels& counted,
  const std::vector<OrientedMesh>& meshes, const VoxelizationSettings& settings,
  const std::function<void(const SamplesInside&)>& take, const Monitor& monitor = {});
/// The same of all of the grid.
std::vector<WindingNumbers> CountSamplesInside(Device& device, const Grid& grid,
  const std::vector<OrientedMesh>& meshes, const VoxelizationSettings& settings,
  const std::function<void(const SamplesInside&)>& take, const Monitor& monitor = {});
}
