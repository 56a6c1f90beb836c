#pragma once

#include "IO/VDB/OpenVDB.h"

#include <string>
#include <vector>

namespace tyndall
{
struct VDBGrid;
}
class vtkDataArray;
class vtkFieldData;
class vtkImageData;

/// Cells of an image from a grid's voxels, and a grid's voxels from cells.
///
/// The one place that knows OpenVDB's trees by their types. None is constructed here, OpenVDB's registry does that
/// (GridBase::createGrid): a constructor would instantiate every virtual function of its tree, 8 s of compiling a type.
namespace tyndall
{
/// Adds the voxels of a box as a cell array, and field data `background` and `type` of the grid (see FieldName).
/// @param type  one of FindValueType, which the grid has
/// @param box   the image's cells
void AddGridCells(const openvdb::GridBase& grid, const std::string& type, const std::string& name,
  const openvdb::CoordBBox& box, vtkImageData* image);

/// Adds the values of a grid's cells at the middle of each cell of another image: linear between the middles of voxels,
/// of integers that of the nearest, and the background beyond. Field data are added, too.
/// @param cells  as AddGridCells made them of `box`
void AddResampled(vtkImageData* cells, const VDBGrid& grid, const openvdb::CoordBBox& box, vtkImageData* image);

/// Makes fog of cells that are a level set (FogInside), and says so in field data `class` and `background`; leaves
/// others as they are. A level set is of real numbers, and its class says so, or is not known where the background is
/// positive and cells are negative.
void MakeFogOfLevelSet(vtkImageData* image, const std::string& name);

/// How cells become voxels.
struct VoxelOptions
{
  double Background = 0.0; ///< where field data `background` of the array does not say another
  /// Of each number: cells so near to the background, or to each other in a block, are equal to it.
  double Tolerance = 0.0;
  bool Half = false;                                  ///< store real numbers in 16 bits; an error where they do not fit
  const std::vector<unsigned char>* Hidden = nullptr; ///< a flag for each cell: it is background, whatever it holds
};

/// The grids of one array: one, or one per component, named after it. Cells that equal the background, to the last bit
/// or to the tolerance, are inactive.
/// @param field  may have `background` and `type` of the array
/// @throws InvalidInput naming the array, where its numbers are none of a grid, or do not fit 16 bits
openvdb::GridPtrVec MakeGrids(
  vtkDataArray* array, vtkFieldData* field, const openvdb::CoordBBox& voxels, const VoxelOptions& options);
}
