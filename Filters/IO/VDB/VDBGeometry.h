#pragma once

#include "IO/VDB/VDBGrid.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

class vtkImageData;

/// Where an image's cells and a grid's voxels are in the world, one from the other.
///
/// A cell is centred on its voxel's index: voxel i is the cell that covers [i - 1/2, i + 1/2] of index space. A grid
/// that was an image notes in its metadata what it does not say itself: the extent of points (voxels may be background
/// up to the border) with the number of cells in it, and origin and spacing to the last bit (OpenVDB computes the scale
/// of a transform as the difference of two positions).
namespace tyndall
{
/// Whether metadata of this name is such a note.
bool IsGeometry(const std::string& key);

/// Where grids lie, as an image.
struct VDBGeometry
{
  std::array<std::int64_t, 6> Extent = { 0, -1, 0, -1, 0, -1 }; ///< of points; wider than VTK's, perhaps
  std::array<double, 3> Origin = { 0, 0, 0 };
  std::array<double, 3> Spacing = { 1, 1, 1 };
  std::array<double, 9> Direction = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };

  bool Empty() const { return this->Extent[0] > this->Extent[1]; }
};

/// Voxels for the cells of an extent of points: a flat image has one layer.
VDBBox VoxelsOf(const std::array<std::int64_t, 6>& extent);

/// Number of them, 0 in an empty extent.
double CellsOf(const std::array<std::int64_t, 6>& extent);

/// The extent of points that a grid covers: the noted one, as long as that still holds every active voxel, or else that
/// of the active voxels.
std::array<std::int64_t, 6> ExtentOf(const VDBGrid& grid);

/// Whether a grid notes that it was an image of this extent, and of as many cells: then the extent is no accident of a
/// corrupt file, however few voxels are active.
bool NotesExtent(const VDBGrid& grid, const std::array<std::int64_t, 6>& extent);

/// Whether a grid's voxels lie where another's do, to rounding.
bool SharesTransform(const VDBGrid& a, const VDBGrid& b);

/// All of some grids, at least one, that share a transform.
VDBGeometry GeometryOf(const std::vector<const VDBGrid*>& grids);

/// An image with axes along those of the world that holds the voxels of some grids, of the shortest edge of theirs.
VDBGeometry BoxAround(const std::vector<const VDBGrid*>& grids);

/// Where an image lies, as a grid.
struct VDBPlacement
{
  openvdb::CoordBBox Voxels;
  openvdb::math::Transform::Ptr Transform;
  openvdb::MetaMap Notes;
};

/// @throws InvalidInput where spacing is not positive, or spacing or origin not finite
VDBPlacement PlacementOf(vtkImageData* image);
}
