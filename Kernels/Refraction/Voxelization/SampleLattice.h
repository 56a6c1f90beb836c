#pragma once

#include "Device/Buffer.h"
#include "Medium/Grid.h"
#include "Refraction/Voxelization/TriangleMesh.h"

#include <array>
#include <vector>

namespace tyndall
{
/// The lattice of whole numbers on which meshes are voxelised exactly.
///
/// Its origin is the grid's lower corner. An edge of a fine voxel, of which there are `samples` in an edge of a voxel,
/// is 2^k units, with k as large as products of three coordinates allow: grid and meshes together are at most 2^20
/// units long. A point of a mesh moves by at most half a unit an axis, a millionth of that length or less, and points
/// at the same place stay together.
class SampleLattice
{
public:
  using Point = std::array<cl_int, 3>;

  /// @throws InvalidInput where a mesh is so large beside the grid that the samples would not fit between the units
  SampleLattice(const Grid& grid, int samples, const std::vector<const TriangleMesh*>& meshes);

  /// The same lattice, its origin moved to the lower corner of a voxel: what is found of a box of the grid is, to the
  /// last bit, what is found of the whole.
  SampleLattice From(const std::array<int, 3>& voxel) const;

  int Samples() const { return this->SamplesOfVoxel; } ///< fine voxels per edge of a voxel
  int Pitch() const { return this->UnitsOfSample; }    ///< units per edge of a fine voxel: a power of 2, at least 2

  std::vector<Point> Rounded(const std::vector<std::array<double, 3>>& points) const;

  /// Whether a mesh is closed as it lies on the lattice. A closed mesh stays so; seams narrower than a unit may close.
  bool Closes(const TriangleMesh& mesh) const;

private:
  std::array<double, 3> Origin;
  std::array<double, 3> UnitsOfLength;
  int SamplesOfVoxel;
  int UnitsOfSample = 2;
  std::array<int, 3> FirstVoxel = { 0, 0, 0 };
};

/// Columns of samples along an axis, side by side in a grid: `count[0]` of them along the lower of the other two axes,
/// in rows, and `count[1]` rows along the higher one.
struct SampleColumns
{
  SampleColumns(const Grid& grid, int axis, int samplesOfVoxel, int pitch);

  int axis;
  int across, up; ///< the other axes: the lower one, the higher one
  int samplesOfVoxel;
  int samples; ///< of a column
  std::array<int, 2> count;
  int pitch; ///< units from sample to sample; the first one is half of that inside the grid
};

/// Samples of a box of fine voxels: from `first` on to before `end`.
struct SampleBox
{
  std::array<int, 3> first, end;
};

/// A mesh on a lattice, and how its triangles are dealt out to work-items.
class LatticeMesh
{
public:
  LatticeMesh(Device& device, const SampleLattice& lattice, const TriangleMesh& mesh);

  const Buffer<cl_int>& Points() const { return this->DevicePoints; }
  const Buffer<cl_int>& Triangles() const { return this->DeviceTriangles; }

  /// Pieces of triangles to look for crossings in, as mark_crossings of Voxelization.cl takes them: few enough columns
  /// each that a large triangle does not hold up a work-item while the others wait.
  std::vector<cl_uint4> Tiles(const SampleColumns& columns, int firstRow, int endRow) const;

  /// The same for crossings in a box.
  std::vector<cl_uint4> Tiles(const SampleColumns& columns, const SampleBox& box) const;

private:
  std::vector<SampleLattice::Point> HostPoints;
  std::vector<std::array<int, 3>> HostTriangles;
  Buffer<cl_int> DevicePoints;
  Buffer<cl_int> DeviceTriangles;
};
}
