#pragma once

#include "IO/VDB/VDBBytes.h"

#include <string>
#include <vector>

namespace tyndall
{
struct VDBGrid;
}
class vtkDataArray;
class vtkFieldData;
class vtkImageData;

/// Converts the voxels of an OpenVDB grid to cells of a VTK image, and cells to voxels.
///
/// Only these functions depend on the types of OpenVDB's trees. OpenVDB's registry (GridBase::createGrid) creates the
/// trees: a constructor call would instantiate every virtual function of the tree, which takes 8 s of compilation per
/// type.
namespace tyndall
{
/// Adds the voxels of a box to an image as a cell array, and the grid's `background` and `type` as field data (see
/// FieldName).
/// @param type  name of the grid's type that FindValueType accepts
/// @param box   voxels that become the cells of the image
void AddGridCells(const openvdb::GridBase& grid, const std::string& type, const std::string& name,
  const openvdb::CoordBBox& box, vtkImageData* image);

/// Resamples a grid at the cell centres of `image`: linearly between voxel centres; integers are taken from the nearest
/// voxel. Outside of the grid, values are the background. Field data are added as by AddGridCells.
/// @param cells  image of the voxels of `box`, as made by AddGridCells
void AddResampled(vtkImageData* cells, const VDBGrid& grid, const openvdb::CoordBBox& box, vtkImageData* image);

/// Converts a cell array to fog if it is a level set (FogInside), and updates field data `class` and `background`.
/// Other arrays are left unchanged. An array of real numbers is a level set if its class says so or, if the class is
/// unknown, if its background is positive and some cells are negative.
void MakeFogOfLevelSet(vtkImageData* image, const std::string& name);

/// Options for the conversion of cells to voxels.
struct VoxelOptions
{
  /// Value of inactive voxels, unless field data `background` of the array state another value.
  double Background = 0.0;
  /// A value counts as equal to the background, or to the first value of its block of 8^3 voxels, if it differs by no
  /// more than this.
  double Tolerance = 0.0;
  bool Half = false; ///< whether real numbers are stored in 16 bits; numbers that do not fit are an error
  /// Flag of each cell, not 0 if the cell becomes background whatever its value; null: no such cells.
  const std::vector<unsigned char>* Hidden = nullptr;
};

/// Makes the grids of one cell array: one grid, or one for each component, named after the array. Cells that equal the
/// background within the tolerance are inactive voxels.
/// @param field  field data, which may contain `background` and `type` of the array
/// @throws InvalidInput naming the array, if no grid type can hold its numbers, or if they do not fit 16 bits
openvdb::GridPtrVec MakeGrids(
  vtkDataArray* array, vtkFieldData* field, const openvdb::CoordBBox& voxels, const VoxelOptions& options);
}
