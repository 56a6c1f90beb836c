#pragma once

#include "IO/VDB/VDBFile.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

class vtkImageData;

/// Converts between the geometry of VTK images and the transforms of OpenVDB grids.
///
/// A voxel has the index of its cell: voxel i is the cell that covers [i - 1/2, i + 1/2] in index space. Metadata of a
/// grid made from an image record what the grid itself does not express. The extent of points and the number of cells
/// are recorded because border voxels may be background. Origin and spacing are recorded to the last bit, because
/// OpenVDB computes the scale of a transform as the difference of two positions.
namespace tyndall
{
/// Whether metadata of this name record the geometry of the image from which the grid was made.
bool IsGeometry(const std::string& key);

/// Geometry of the VTK image that one or several grids become: extent, origin, spacing, direction matrix.
struct VDBGeometry
{
  /// Extent of points, which may exceed the range of VTK's extents.
  std::array<std::int64_t, 6> Extent = { 0, -1, 0, -1, 0, -1 };
  std::array<double, 3> Origin = { 0, 0, 0 };
  std::array<double, 3> Spacing = { 1, 1, 1 };
  std::array<double, 9> Direction = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };

  bool Empty() const { return this->Extent[0] > this->Extent[1]; }
};

/// Voxels that correspond to the cells of an extent of points; a flat extent has one layer of cells.
VDBBox VoxelsOf(const std::array<std::int64_t, 6>& extent);

/// Number of cells of an extent of points; 0 for an empty extent.
double CellsOf(const std::array<std::int64_t, 6>& extent);

/// The extent of points that a grid covers: the extent recorded in its metadata if that still contains every active
/// voxel, otherwise the extent of the active voxels.
std::array<std::int64_t, 6> ExtentOf(const VDBGrid& grid);

/// Whether a grid's metadata record that the grid was made from an image of this extent, and also record the number of
/// cells of this extent. A large extent with few active voxels is then no sign of a corrupt file.
bool NotesExtent(const VDBGrid& grid, const std::array<std::int64_t, 6>& extent);

/// Whether the voxels of two grids coincide, up to rounding of their transforms.
bool SharesTransform(const VDBGrid& a, const VDBGrid& b);

/// The common geometry of one or more grids that share a transform.
VDBGeometry GeometryOf(const std::vector<const VDBGrid*>& grids);

/// Geometry of an image along the world axes that contains the voxels of all given grids; its spacing is the shortest
/// edge of their voxels.
VDBGeometry BoxAround(const std::vector<const VDBGrid*>& grids);

/// Geometry of the OpenVDB grid that a VTK image becomes: voxels, transform, and metadata that record the image's
/// geometry (IsGeometry).
struct VDBPlacement
{
  openvdb::CoordBBox Voxels;
  openvdb::math::Transform::Ptr Transform;
  openvdb::MetaMap Notes;
};

/// Converts the geometry of an image to that of a grid.
/// @throws InvalidInput if a spacing is not positive, or spacing or origin is not finite
VDBPlacement PlacementOf(vtkImageData* image);
}
