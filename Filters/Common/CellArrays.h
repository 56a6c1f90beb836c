#pragma once

#include "Common/ImageInput.h"
#include "Medium/Field.h"
#include "Medium/Grid.h"

#include "vtkFloatArray.h"
#include "vtkSmartPointer.h"

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkDataObject;
class vtkDataSetAttributes;
class vtkImageData;
class vtkInformation;

/// Reads arrays of images as values of voxels, and chooses these arrays. Functions throw InvalidInput with a message
/// for users.
namespace tyndall
{
/// The grid of an image's cells; the image's extent may start anywhere.
/// @throws InvalidInput if there is no image or no cell, if a spacing is not a positive number, or if the image is
///   rotated
Grid GridOf(vtkImageData* image);

/// The array itself if it is a vtkFloatArray, otherwise a converted copy; null for null.
vtkSmartPointer<vtkFloatArray> AsFloats(vtkDataArray* array);

/// An array of floats together with shared ownership of its memory.
class FloatField
{
public:
  FloatField() = default; ///< a quantity that is zero everywhere
  explicit FloatField(vtkSmartPointer<vtkFloatArray> array)
    : Array(std::move(array))
  {
  }

  bool IsThere() const { return this->Array != nullptr; }
  int Components() const { return this->Array ? this->Array->GetNumberOfComponents() : 1; }
  const float* Values() const { return this->Array ? this->Array->GetPointer(0) : nullptr; }
  operator Field() const { return { this->Values(), this->Components() }; }

private:
  vtkSmartPointer<vtkFloatArray> Array;
};

enum class Need
{
  Required, ///< a missing array is an error
  Optional, ///< a missing array is an empty FloatField, unless the user chose that array
};

/// Names of arrays, for messages: 'a', 'b', or none.
std::string NamesOf(vtkDataSetAttributes* attributes);

/// Numbers of components that an array may have; empty: any.
using Components = std::initializer_list<int>;

/// @throws InvalidInput, naming the array, unless it has so many tuples, and one of these numbers of components
void CheckShape(vtkDataArray* array, const std::string& name, vtkIdType tuples, Components components);

/// Reads values of the image's cells from the cell array `name`, or from the point array `name` averaged to cells. (If
/// voxels are around points, Guarded has already turned point arrays into cell arrays, ImageInput.h.) Float arrays are
/// used in place, other types are converted. Hidden cells (ImageInput.h) read as 0, or as refractive index 1.
/// @throws InvalidInput naming the array and its number of components, or the arrays that exist
FloatField ReadCells(vtkImageData* image, const std::string& name, Need need, Components components = { 1, 3 });

/// The same for the array that SetInputArrayToProcess selected as number `index`, by name or by attribute. If a point
/// array was selected, it takes precedence over a cell array of the same name. If nothing was selected (SCALARS in VTK,
/// "" in ParaView before it knows the input), or the name `otherwise`, the function reads the array that the filter
/// upstream used for this quantity (NoteChoices), or else the array `otherwise`, where "" stands for the active
/// scalars. An array selected by another name is never optional.
FloatField ReadChosenCells(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise,
  Need need, Components components = { 1, 3 });

/// The array that ReadChosenCells would read, or null. Its type and shape are not checked.
vtkDataArray* ChosenArray(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise);

/// Names of the arrays that a filter reads from an image, among those that the image has.
struct ArraysRead
{
  std::vector<std::string> ofCells, ofPoints;
};
ArraysRead FindArrays(vtkAlgorithm* filter, const VoxelArrays& arrays, vtkImageData* image);

/// Whether some arrays are selected by SetInputArrayToProcess, or announced as active, and all of these are point
/// arrays.
/// @param chosen  VoxelArrays::chosen
bool ChoosesOnlyPoints(vtkAlgorithm* filter, const std::vector<std::string>& chosen, vtkInformation* input);

/// Indices for SetInputArrayToProcess with the names of the default arrays.
using Quantities = std::vector<std::pair<int, std::string>>;

/// Records in the output's field data which of its arrays the filter used for these quantities, so that filters
/// downstream use the same ones: `sigma_a_array` and so on, a text with the array's name, followed by "points" if the
/// point array takes precedence over a cell array of that name. Nothing is recorded for a default array.
/// @param input  the filter's input, whose arrays the output has
void NoteChoices(vtkAlgorithm* filter, const Quantities& quantities, vtkImageData* input, vtkImageData* output);

/// Removes what the input recorded, for a filter that computes a medium's arrays itself.
void ForgetChoices(vtkImageData* output);

/// Whether the array that ReadChosenCells would read exists and differs from the value `usual` in a cell that is not
/// hidden. For filters that ignore the quantity; nothing else is checked.
bool IsUnusual(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& name, float usual);

/// Reads one number from field data `name`; returns `missing` if there is no such field data.
/// @throws InvalidInput if it is not exactly one number
double ReadFact(vtkDataObject* data, const char* name, double missing);

/// Whether the voxels of a grid have the same corners as those of the medium, up to rounding.
bool AreSameVoxels(const Grid& grid, const Grid& medium);

/// @param whose, remedy  parts of the message, e.g. "The octree", "Make the octree of the same medium."
/// @throws InvalidInput unless the voxels of the grid have the same corners as those of the medium, up to rounding
void CheckSameVoxels(const Grid& grid, const Grid& medium, const std::string& whose, const std::string& remedy);
}
