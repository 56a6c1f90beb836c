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
/// Its origin is the grid's lower corner. Each voxel has `samples` fine voxels per edge, and an edge of a fine voxel is
/// 2^k units long. k is the largest for which grid and meshes together are at most 2^20 units long, so that products of
/// three coordinates are exact. Rounding to the lattice moves a point of a mesh by at most half a unit per axis, at
/// most a millionth of the total length. Coincident points stay coincident.
class SampleLattice
{
public:
  using Point = std::array<cl_int, 3>;

  /// Chooses the unit of the lattice for a grid and all meshes that are voxelised on it.
  /// @throws InvalidInput if a mesh is so large relative to the grid that the distance of samples would be below a unit
  SampleLattice(const Grid& grid, int samples, const std::vector<const TriangleMesh*>& meshes);

  /// This lattice with its origin moved to the lower corner of a voxel, for voxelising a box of the grid. The voxels of
  /// the box then obtain bitwise the same values as if the entire grid were voxelised.
  SampleLattice From(const std::array<int, 3>& voxel) const;

  int Samples() const { return this->SamplesOfVoxel; } ///< number of fine voxels per edge of a voxel
  /// Number of lattice units per edge of a fine voxel: a power of 2, at least 2.
  int Pitch() const { return this->UnitsOfSample; }

  /// Points in lattice units, each coordinate rounded to an integer.
  std::vector<Point> Rounded(const std::vector<std::array<double, 3>>& points) const;

  /// Whether a mesh is closed after rounding to the lattice. A closed mesh stays closed; gaps narrower than a lattice
  /// unit may close.
  bool Closes(const TriangleMesh& mesh) const;

private:
  std::array<double, 3> Origin;
  std::array<double, 3> UnitsOfLength;
  int SamplesOfVoxel;
  int UnitsOfSample = 2;
  std::array<int, 3> FirstVoxel = { 0, 0, 0 }; ///< voxel of the grid at whose lower corner the origin is
};

/// Columns of samples along an axis, arranged in a 2D grid: `count[0]` columns per row, along the lower of the other
/// two axes, and `count[1]` rows, along the higher of them.
struct SampleColumns
{
  SampleColumns(const Grid& grid, int axis, int samplesOfVoxel, int pitch);

  int axis;                 ///< axis along which the columns of samples run
  int across, up;           ///< the lower and the higher one of the other two axes
  int samplesOfVoxel;       ///< number of samples per edge of a voxel
  int samples;              ///< number of samples in a column
  std::array<int, 2> count; ///< number of columns per row, and number of rows
  int pitch; ///< distance of adjacent samples, in lattice units; the first sample is half of it inside the grid
};

/// A box of samples (fine voxels): indices from `first` to below `end` along each axis.
struct SampleBox
{
  std::array<int, 3> first, end;
};

/// A mesh rounded to a lattice, on the host and on the device, and the division of its triangles among work-items.
class LatticeMesh
{
public:
  LatticeMesh(Device& device, const SampleLattice& lattice, const TriangleMesh& mesh);

  const Buffer<cl_int>& Points() const { return this->DevicePoints; } ///< 3 coordinates per point, units of the lattice
  const Buffer<cl_int>& Triangles() const { return this->DeviceTriangles; } ///< 3 point indices per triangle

  /// Divides the triangles into tiles for the kernel mark_crossings (Voxelization.cl), one work-item each. A tile is a
  /// triangle with a rectangle of columns, in the given rows, that the triangle may cross. Its number of columns is
  /// limited, so that a large triangle does not keep one work-item busy while the others wait.
  std::vector<cl_uint4> Tiles(const SampleColumns& columns, int firstRow, int endRow) const;

  /// Divides the triangles into tiles, as the function above, for the columns in a box of samples.
  std::vector<cl_uint4> Tiles(const SampleColumns& columns, const SampleBox& box) const;

private:
  std::vector<SampleLattice::Point> HostPoints;
  std::vector<std::array<int, 3>> HostTriangles;
  Buffer<cl_int> DevicePoints;
  Buffer<cl_int> DeviceTriangles;
};
}
