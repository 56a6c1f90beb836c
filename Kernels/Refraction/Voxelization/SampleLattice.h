#pragma once

#include "Device/Buffer.h"
#include "Medium/Grid.h"
#include "Refraction/Voxelization/TriangleMesh.h"

#include <array>
#include <vector>

namespace tyndall
{
/// The integer lattice on which meshes are voxelised exactly.
///
/// Its origin is the grid's lower corner. An edge of a fine voxel, of which there are `samples` in an edge of a voxel,
/// is 2^k units long, with k as large as exact products of three coordinates allow: grid and meshes together are at
/// most 2^20 units long. Rounding to the lattice moves a point of a mesh by at most half a unit per axis, a millionth
/// of that length or less; coincident points stay coincident.
class SampleLattice
{
public:
  using Point = std::array<cl_int, 3>;

  /// @throws InvalidInput if a mesh is so large relative to the grid that the samples would be closer than the units
  SampleLattice(const Grid& grid, int samples, const std::vector<const TriangleMesh*>& meshes);

  /// The same lattice with its origin at the lower corner of a voxel: results for a box of the grid are bitwise equal
  /// to those for the whole.
  SampleLattice From(const std::array<int, 3>& voxel) const;

  int Samples() const { return this->SamplesOfVoxel; } ///< fine voxels per edge of a voxel
  int Pitch() const { return this->UnitsOfSample; }    ///< units per edge of a fine voxel: a power of 2, at least 2

  std::vector<Point> Rounded(const std::vector<std::array<double, 3>>& points) const;

  /// Whether a mesh is closed after rounding to the lattice. A closed mesh stays closed; seams narrower than a unit may
  /// close.
  bool Closes(const TriangleMesh& mesh) const;

private:
  std::array<double, 3> Origin;
  std::array<double, 3> UnitsOfLength;
  int SamplesOfVoxel;
  int UnitsOfSample = 2;
  std::array<int, 3> FirstVoxel = { 0, 0, 0 };
};

/// Columns of samples along an axis, arranged in a 2D grid: `count[0]` columns per row, along the lower of the other
/// two axes, and `count[1]` rows along the higher one.
struct SampleColumns
{
  SampleColumns(const Grid& grid, int axis, int samplesOfVoxel, int pitch);

  int axis;
  int across, up; ///< the other axes: the lower one, the higher one
  int samplesOfVoxel;
  int samples; ///< number of samples in a column
  std::array<int, 2> count;
  int pitch; ///< units from sample to sample; the first sample lies half a pitch inside the grid
};

/// A box of fine voxels: samples with indices from `first` to before `end`.
struct SampleBox
{
  std::array<int, 3> first, end;
};

/// A mesh rounded to a lattice, and the division of its triangles among work-items.
class LatticeMesh
{
public:
  LatticeMesh(Device& device, const SampleLattice& lattice, const TriangleMesh& mesh);

  const Buffer<cl_int>& Points() const { return this->DevicePoints; }
  const Buffer<cl_int>& Triangles() const { return this->DeviceTriangles; }

  /// Tiles of triangles in which to look for crossings, the input of mark_crossings in Voxelization.cl. Each covers few
  /// enough columns that a large triangle does not keep one work-item busy while the others wait.
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
