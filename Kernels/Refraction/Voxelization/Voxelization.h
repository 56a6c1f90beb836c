#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"
#include "Refraction/Voxelization/TriangleMesh.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace tyndall
{
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

struct VoxelizationSettings
{
  int samples = 4; ///< fine voxels per edge of a voxel, 1 to 16

  /// Whether counts include fractions of samples, from the position of the surface between samples. Otherwise occupancy
  /// comes in steps of 1 / samples^3, as published.
  bool fractions = true;

  /// Axis of the columns, 0, 1 or 2; a crossing toggles the samples before it or, with fromAbove, those after it. The
  /// result is the same to the last bit.
  int columnAxis = 0;
  bool fromAbove = false;

  /// Maximum memory of the fine grid, one bit per sample, held at a time: a slab of voxels, of at least one layer.
  std::size_t slabBytes = std::size_t(16) << 20;
};

/// Number of units of a count per sample.
constexpr int UnitsOfSample(int samples)
{
  return 65535 / (samples * samples * samples);
}

/// @throws InvalidInput
void Check(const VoxelizationSettings& settings);

/// A closed mesh and the orientation of its triangles.
struct OrientedMesh
{
  /// Closed, if necessary after rounding to the lattice; see Examine. Triangles without area have no effect.
  const TriangleMesh* mesh = nullptr;
  int orientation = 1; ///< 1: counterclockwise seen from outside; -1: clockwise; 0: its triangles disagree
};

/// Samples inside one of several meshes, in the voxels of a slab.
struct SamplesInside
{
  std::size_t mesh; ///< index of the mesh
  /// One per voxel, 0 to samples^3 UnitsOfSample(samples), x fastest. Overwritten for the next mesh.
  const Buffer<cl_ushort>& counts;

  /// The slab consists of `runs` runs of `length` consecutive voxels of the box: the first run begins at voxel `first`,
  /// each next one `stride` voxels later.
  std::size_t first, length, stride, runs;
  std::size_t VoxelCount() const { return this->length * this->runs; }
};

/// The voxels of a grid that are voxelised.
struct CountedVoxels
{
  VoxelBox box; ///< voxels whose samples are counted
  VoxelBox own; ///< voxels in `box` that winding numbers refer to

  static CountedVoxels All(const Grid& grid) { return { { {}, grid.size }, { {}, grid.size } }; }
};

/// Counts the samples of each voxel that lie inside each of several closed meshes. Where meshes overlap, samples belong
/// to the last of them.
///
/// Bit-slice voxelisation of Eisemann and Decoret (Single-pass GPU solid voxelization for real-time applications,
/// Graphics Interface 2008; Pfeuti 2009, section 3.1.2): a column of samples is a row of bits, and every triangle
/// toggles the bits before it. Samples are the centres of fine voxels. Points of the mesh are rounded to a lattice of a
/// millionth of the box (SampleLattice); from there on everything is exact: a crossing of a column with an edge or a
/// corner is counted once, a closed mesh never leaks, and whether a sample is inside does not depend on the direction
/// of its column. Then fractions of samples are added or subtracted, from where the surface crosses columns along x, y
/// and z (SurfaceFraction); a voxel that the surface does not touch is all inside or all outside.
///
/// Results for a voxel do not depend on which box of the grid is requested, to the last bit, with one exception: in the
/// outermost voxels of a box that ends within the grid, the side of features thinner than a sample is decided without
/// the sample beyond the box.
///
/// @param take  receives the results slab by slab, and within a slab mesh by mesh from the last to the first, so that
///   device memory does not grow with the size of the grid or the number of meshes
/// @return for each mesh, whether its winding number is 0 or 1 at all samples. Where it is not, the samples inside are
///   those with an odd winding number. Unknown if the orientation is 0: the numbers are then those of a closed, well
///   oriented mesh
/// @throws InvalidInput   if a setting or a mesh's size is invalid
/// @throws DeviceError    if the meshes and a slab do not fit the device
std::vector<WindingNumbers> CountSamplesInside(Device& device, const Grid& grid, const CountedVoxels& counted,
  const std::vector<OrientedMesh>& meshes, const VoxelizationSettings& settings,
  const std::function<void(const SamplesInside&)>& take, const Monitor& monitor = {});
}
