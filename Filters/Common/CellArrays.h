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

/// Reads arrays of images as values of voxels, and determines which arrays a filter reads. Functions throw InvalidInput
/// with a message for users.
namespace tyndall
{
/// Grid of the cells of an image, whose extent may start at any index.
/// @throws InvalidInput if there is no image or no cell, if a spacing is not a positive number, or if the image is
///   rotated
Grid GridOf(vtkImageData* image);

/// Returns the array itself if it is a vtkFloatArray, otherwise a converted copy; null for null.
vtkSmartPointer<vtkFloatArray> AsFloats(vtkDataArray* array);

/// An array of floats together with shared ownership of its memory.
class FloatField
{
public:
  FloatField() = default; ///< no array: the quantity is zero everywhere
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

/// Lists the names of all arrays for a message, such as 'a', 'b'; "none" if there are no arrays.
std::string NamesOf(vtkDataSetAttributes* attributes);

/// Allowed numbers of components of an array; empty: any.
using Components = std::initializer_list<int>;

/// Checks the shape of an array.
/// @throws InvalidInput, naming the array, unless it has `tuples` tuples and one of the allowed numbers of components
void CheckShape(vtkDataArray* array, const std::string& name, vtkIdType tuples, Components components);

/// Reads one value per cell and component of the image from the cell array `name`, or from the point array `name`
/// averaged to cells. (If point arrays are read with one voxel around each point, Guarded has already made cell arrays
/// of them, ImageInput.h.) Float arrays are used in place, other types are converted. Hidden cells (ImageInput.h) read
/// as 0, or as refractive index 1.
/// @throws InvalidInput naming the array and its number of components, or the arrays that exist if it is missing
FloatField ReadCells(vtkImageData* image, const std::string& name, Need need, Components components = { 1, 3 });

/// Calls ReadCells for the array that the user selected for number `index` of SetInputArrayToProcess, by name or by
/// attribute. A selected point array takes precedence over a cell array of the same name. If the user selected nothing
/// (SCALARS in VTK, "" in ParaView before it knows the input), or selected the default array `otherwise`, the function
/// reads the array that the filter upstream used for this quantity (NoteChoices) or, without such a record, the array
/// `otherwise` ("": the active scalars). An array selected by another name is never optional.
FloatField ReadChosenCells(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise,
  Need need, Components components = { 1, 3 });

/// Returns the array that is selected as for ReadChosenCells; null if there is none. Type and shape are not checked.
vtkDataArray* ChosenArray(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise);

/// Names of the arrays that a filter reads from an image, among those that the image has.
struct ArraysRead
{
  std::vector<std::string> ofCells, ofPoints;
};
ArraysRead FindArrays(vtkAlgorithm* filter, const VoxelArrays& arrays, vtkImageData* image);

/// Whether a filter selects at least one array, and only point arrays. The filter selects arrays by
/// SetInputArrayToProcess; if it selects the active array of an attribute type, the array must be announced by the
/// input's information.
/// @param chosen  default names of the selectable arrays, by index (VoxelArrays::chosen)
bool ChoosesOnlyPoints(vtkAlgorithm* filter, const std::vector<std::string>& chosen, vtkInformation* input);

/// Indices for SetInputArrayToProcess, each with the name of its default array.
using Quantities = std::vector<std::pair<int, std::string>>;

/// Records in the output's field data which arrays the filter used for `quantities`, so that filters downstream use the
/// same arrays: one text per quantity, named `sigma_a_array` and so on, with the array's name, followed by "points" if
/// the point array takes precedence over a cell array of that name. Nothing is recorded for a default array.
/// @param input  the filter's input; its arrays are also in the output
void NoteChoices(vtkAlgorithm* filter, const Quantities& quantities, vtkImageData* input, vtkImageData* output);

/// Removes records of NoteChoices, which the output has inherited from the input. For filters that compute the medium's
/// arrays themselves.
void ForgetChoices(vtkImageData* output);

/// Whether an array selected as for ReadChosenCells exists and differs from the value `usual` in a cell that is not
/// hidden. Filters that ignore this array then warn. Type and shape are not checked.
bool IsUnusual(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& name, float usual);

/// Reads one number from field data `name`; returns `missing` if there is no such field data.
/// @throws InvalidInput if the field data array does not hold exactly one number
double ReadFact(vtkDataObject* data, const char* name, double missing);

/// Whether the voxels of a grid have the same corners as those of the medium, to a thousandth of a voxel edge.
bool AreSameVoxels(const Grid& grid, const Grid& medium);

/// Checks that the voxels of a grid have the same corners as those of the medium, to a thousandth of a voxel edge.
/// @param whose, remedy  beginning and end of the message, e.g. "The octree", "Make the octree of the same medium."
/// @throws InvalidInput if the corners differ
void CheckSameVoxels(const Grid& grid, const Grid& medium, const std::string& whose, const std::string& remedy);
}
