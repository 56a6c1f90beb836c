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

/// Converts a grid's voxels to cells of an image, and cells to voxels.
///
/// No other code depends on the types of OpenVDB's trees. Trees are created by OpenVDB's registry
/// (GridBase::createGrid): calling a constructor would instantiate every virtual function of the tree, 8 s of
/// compilation per type.
namespace tyndall
{
/// Adds the voxels of a box as a cell array, and the grid's `background` and `type` as field data (see FieldName).
/// @param type  the grid's type, one of FindValueType
/// @param box   voxels of the image's cells
void AddGridCells(const openvdb::GridBase& grid, const std::string& type, const std::string& name,
  const openvdb::CoordBBox& box, vtkImageData* image);

/// Resamples a grid at the cell centres of another image: linear between voxel centres, for integers the nearest voxel,
/// and the background outside. Field data are added as well.
/// @param cells  the voxels of `box`, as AddGridCells made them
void AddResampled(vtkImageData* cells, const VDBGrid& grid, const openvdb::CoordBBox& box, vtkImageData* image);

/// Converts a cell array to fog if it is a level set (FogInside), and updates field data `class` and `background`.
/// Other arrays are left unchanged. A level set consists of real numbers, and its class says so, or its class is
/// unknown, its background is positive and some cells are negative.
void MakeFogOfLevelSet(vtkImageData* image, const std::string& name);

/// Options for the conversion of cells to voxels.
struct VoxelOptions
{
  double Background = 0.0; ///< used unless field data `background` of the array give another value
  /// Numbers that differ from the background, or from each other within a block, by no more than this count as equal.
  double Tolerance = 0.0;
  bool Half = false; ///< store real numbers in 16 bits; numbers that do not fit are an error
  /// A flag for each cell: it becomes background, whatever its value.
  const std::vector<unsigned char>* Hidden = nullptr;
};

/// Makes the grids of one array: one grid, or one for each component, named after the array. Cells that equal the
/// background, exactly or within the tolerance, are inactive.
/// @param field  may contain `background` and `type` of the array
/// @throws InvalidInput naming the array, if no grid can hold its numbers, or they do not fit 16 bits
openvdb::GridPtrVec MakeGrids(
  vtkDataArray* array, vtkFieldData* field, const openvdb::CoordBBox& voxels, const VoxelOptions& options);
}
