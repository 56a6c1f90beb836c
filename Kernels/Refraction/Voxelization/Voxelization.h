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
/// Winding numbers of a mesh at samples. A sample is odd if its winding number is neither 0 nor 1. The mesh then
/// intersects itself, is partly inside out, or has parts inside each other.
struct WindingNumbers
{
  std::size_t oddSamples = 0;  ///< number of odd samples, whose winding number is neither 0 nor 1
  int lowest = 0, highest = 1; ///< least and largest of 0, 1 and the winding numbers of all samples
  /// Position of the first odd sample, in the order z, y, x (x fastest) for columns along x; (0, 0, 0) if there is
  /// none.
  std::array<double, 3> firstOddSample = { 0, 0, 0 };
  /// Index of the first odd sample (winding number neither 0 nor 1) along each axis of the domain.
  std::array<int, 3> firstOddNumber = { 0, 0, 0 };

  /// Adds the winding numbers of the mesh at other samples, which were found with columns along x.
  void Add(const WindingNumbers& others);
};

struct VoxelizationSettings
{
  int samples = 4; ///< number of samples (fine voxels) per edge of a voxel, 1 to 16

  /// Whether counts include fractions of samples, computed from the position of the surface between samples. If
  /// false, occupancy is a multiple of 1 / samples^3, as published.
  bool fractions = true;

  /// Axis of the columns of samples, 0, 1 or 2. The choice does not change a bit of the result.
  int columnAxis = 0;

  /// Maximum memory of a slab, bytes. A slab is the part of the fine grid that is processed at a time, with one bit per
  /// sample; it has at least one layer of voxels.
  std::size_t slabBytes = std::size_t(16) << 20;
};

/// Number that one sample adds to a voxel's count. Counts are integers in units of 1 / UnitsOfSample of a sample, so
/// that they can include fractions of a sample; the count of a voxel fits 16 bits.
constexpr int UnitsOfSample(int samples)
{
  return 65535 / (samples * samples * samples);
}

/// Checks the settings.
/// @throws InvalidInput if a setting is out of range
void Check(const VoxelizationSettings& settings);

/// A closed mesh and the orientation of its triangles.
struct OrientedMesh
{
  /// The mesh. It must be closed, at least after rounding to the lattice (CheckClosed). Triangles without area have no
  /// effect.
  const TriangleMesh* mesh = nullptr;
  int orientation = 1; ///< 1: counterclockwise as seen from outside; -1: clockwise; 0: triangles disagree
};

/// Counts of the samples inside one of several meshes in a slab, the voxels that are processed at a time.
struct SamplesInside
{
  std::size_t mesh; ///< index of the mesh, in the order in which CountSamplesInside was given the meshes
  /// Count of each voxel of the slab, in units of 1 / UnitsOfSample(samples) of a sample: 0 to samples^3
  /// UnitsOfSample(samples), x fastest. Overwritten for the next mesh.
  const Buffer<cl_ushort>& counts;

  /// Position of the slab's voxels in the box: `runs` runs of `length` consecutive voxels. The first run begins at
  /// voxel `first`, each later run `stride` voxels after the one before.
  std::size_t first, length, stride, runs;
  std::size_t VoxelCount() const { return this->length * this->runs; }
};

/// The voxels of a grid that are voxelised on one rank.
struct CountedVoxels
{
  VoxelBox box; ///< voxels whose samples are counted
  VoxelBox own; ///< voxels in `box` in which winding numbers are examined: those that belong to no other rank

  static CountedVoxels All(const Grid& grid) { return { { {}, grid.size }, { {}, grid.size } }; }
};

/// Counts the samples of each voxel that lie inside each of several closed meshes. Where meshes overlap, samples
/// belong to the last of them.
///
/// Bit-slice voxelisation of Eisemann and Decoret (Single-pass GPU solid voxelization for real-time applications,
/// Graphics Interface 2008; Pfeuti 2009, section 3.1.2): a column of samples is a row of bits, and every triangle
/// toggles the bits before its crossing. Samples are the centres of fine voxels. Points of the mesh are rounded to a
/// lattice of a millionth of the box (SampleLattice); all further arithmetic is exact. A crossing of a column with an
/// edge or a corner is therefore counted once, a closed mesh never leaks, and whether a sample is inside does not
/// depend on the direction of its column. Fractions of samples are then added or subtracted, from the positions where
/// the surface crosses columns along x, y and z (SurfaceFraction). A voxel that the surface does not touch is entirely
/// inside or outside.
///
/// Results for a voxel do not depend, to the last bit, on the box of the grid that is requested, with one exception. In
/// the outermost voxels of a box that ends within the grid, the sample beyond the box is not known when the sign of a
/// crossing (entering or leaving the mesh) is decided. This matters for features thinner than the distance of samples.
///
/// @param take  callback that receives the counts slab by slab, and within a slab mesh by mesh from the last to the
///   first. Device memory therefore does not grow with the size of the grid or the number of meshes
/// @return the winding numbers of each mesh at the samples of counted.own. Where they are neither 0 nor 1, samples
///   with an odd winding number count as inside. If the orientation of a mesh is 0, its winding numbers are unknown
///   and returned as those of a closed, consistently oriented mesh
/// @throws InvalidInput   if a setting or a mesh's size is invalid
/// @throws DeviceError    if the meshes and a slab do not fit into the device's memory
std::vector<WindingNumbers> CountSamplesInside(Device& device, const Grid& grid, const CountedVoxels& counted,
  const std::vector<OrientedMesh>& meshes, const VoxelizationSettings& settings,
  const std::function<void(const SamplesInside&)>& take, const Monitor& monitor = {});
}
