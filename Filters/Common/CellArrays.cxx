#include "Common/CellArrays.h"

#include "Common/Failure.h"
#include "Common/LightTransportWriting.h"
#include "Device/Errors.h"
#include "Device/HostThreads.h"
#include "Medium/Medium.h"
#include "Numerics/NumberText.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointDataToCellData.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tyndall
{
namespace
{
template <class Array>
bool ConvertInThreads(vtkDataArray* array, vtkFloatArray* floats)
{
  using Value = typename Array::ValueType;
  auto* const values = vtkArrayDownCast<Array>(array);
  if (!values)
  {
    return false;
  }
  floats->SetName(values->GetName());
  floats->SetNumberOfComponents(values->GetNumberOfComponents());
  floats->SetNumberOfTuples(values->GetNumberOfTuples());
  const Value* const from = values->GetPointer(0);
  float* const to = floats->GetPointer(0);
  InThreads(static_cast<std::size_t>(values->GetNumberOfValues()), 65536, [&](std::size_t begin, std::size_t end) {
    std::transform(from + begin, from + end, to + begin, [](Value value) { return static_cast<float>(value); });
  });
  return true;
}
}

vtkSmartPointer<vtkFloatArray> AsFloats(vtkDataArray* array)
{
  auto* const given = vtkArrayDownCast<vtkFloatArray>(array);
  if (given || !array)
  {
    return given;
  }
  auto floats = vtkSmartPointer<vtkFloatArray>::New();
  // The two most frequent array types are converted in parallel: doubles of VTK's filters and bytes of octree levels.
  if (!ConvertInThreads<vtkDoubleArray>(array, floats) && !ConvertInThreads<vtkUnsignedCharArray>(array, floats))
  {
    floats->DeepCopy(array);
  }
  return floats;
}

namespace
{
std::string Quoted(const std::string& name)
{
  return "'" + name + "'";
}

std::string Listed(Components components)
{
  std::string text;
  for (int count : components)
  {
    text += (text.empty() ? "" : " or ") + std::to_string(count);
  }
  return text;
}
}

void CheckShape(vtkDataArray* array, const std::string& name, vtkIdType tuples, Components components)
{
  const int given = array->GetNumberOfComponents();
  if (components.size() > 0 && std::find(components.begin(), components.end(), given) == components.end())
  {
    throw InvalidInput("Array " + Quoted(name) + " has " + std::to_string(given) + " components; it must have " +
      Listed(components) + ".");
  }
  Require(array->GetNumberOfTuples() == tuples,
    "Array " + Quoted(name) + " has " + std::to_string(array->GetNumberOfTuples()) + " values where the dataset has " +
      std::to_string(tuples) + ".");
}

namespace
{
vtkSmartPointer<vtkFloatArray> AveragedToCells(vtkImageData* image, vtkFloatArray* ofPoints)
{
  vtkNew<vtkImageData> points;
  points->CopyStructure(image);
  vtkNew<vtkFloatArray> named; // vtkPointDataToCellData drops arrays without a name
  named->ShallowCopy(ofPoints);
  named->SetName("averaged");
  points->GetPointData()->AddArray(named);
  vtkNew<vtkPointDataToCellData> average;
  average->SetInputData(points);
  average->Update();
  return vtkArrayDownCast<vtkFloatArray>(average->GetOutput()->GetCellData()->GetArray("averaged"));
}

/// A cell or point array that was found by its name; type and shape are not checked.
struct Found
{
  vtkDataArray* array = nullptr;
  bool ofPoints = false;
};

/// Returns the array `ofCells`, or, if the image has hidden cells, a copy in which the hidden cells have the value
/// `empty`.
vtkSmartPointer<vtkFloatArray> WithoutHidden(
  vtkImageData* image, const vtkSmartPointer<vtkFloatArray>& ofCells, float empty)
{
  const std::vector<unsigned char> hidden = HiddenCells(image);
  if (hidden.empty())
  {
    return ofCells;
  }
  auto visible = vtkSmartPointer<vtkFloatArray>::New();
  visible->DeepCopy(ofCells);
  const int components = visible->GetNumberOfComponents();
  for (std::size_t i = 0; i < hidden.size(); ++i)
  {
    if (hidden[i])
    {
      std::fill_n(visible->GetPointer(static_cast<vtkIdType>(i) * components), components, empty);
    }
  }
  return visible;
}

/// Converts a cell or point array to floats, one value per cell and component; point arrays are averaged to cells.
/// @param empty  value of hidden cells
/// @throws InvalidInput if the array does not have one tuple for each cell or point, or has a number of components that
///   is not allowed
FloatField ToField(vtkImageData* image, const Found& found, const std::string& name, Components components, float empty)
{
  CheckShape(found.array, name, found.ofPoints ? image->GetNumberOfPoints() : image->GetNumberOfCells(), components);
  const vtkSmartPointer<vtkFloatArray> floats = AsFloats(found.array);
  return FloatField(WithoutHidden(image, found.ofPoints ? AveragedToCells(image, floats) : floats, empty));
}

/// The array selected by SetInputArrayToProcess: by its name or by its attribute type.
struct Choice
{
  std::string name;   ///< name of the array; empty: selected by attribute
  int attribute = -1; ///< attribute type, e.g. SCALARS; -1: selected by name
  bool pointsFirst = false;
  bool made = false; ///< whether the user selected an array other than the default array
};

/// The name that ParaView's panel passes if the input has no array of the default name (none_string of the proxies).
const char* const NothingChosen = "(by name)";

/// Text that NoteChoices writes after an array's name if the point array of that name takes precedence over the cell
/// array.
const char* const OfPoints = "points";

std::string ChoiceFact(const std::string& quantity)
{
  return quantity + "_array";
}

/// Replaces `choice`, the default array of a quantity such as sigma_a, by the array that the filter upstream used for
/// that quantity, if that filter recorded it in field data (NoteChoices) and the image still has it.
void FollowFilterBefore(vtkImageData* image, Choice& choice)
{
  auto* const said =
    vtkArrayDownCast<vtkStringArray>(image->GetFieldData()->GetAbstractArray(ChoiceFact(choice.name).c_str()));
  const std::string name = said && said->GetNumberOfValues() > 0 ? said->GetValue(0) : std::string();
  const bool isThere = image->GetCellData()->GetArray(name.c_str()) || image->GetPointData()->GetArray(name.c_str());
  if (!name.empty() && isThere)
  {
    choice.name = name;
    choice.pointsFirst = said->GetNumberOfValues() > 1 && said->GetValue(1) == OfPoints;
  }
}

/// The array that is selected under the number `index` of SetInputArrayToProcess; if none is selected, the array that
/// the filter upstream used in place of the default array `otherwise`; if there is no such array, the default array.
/// @param image  the filter's input; null: the array of the filter upstream is not looked up
Choice ChoiceOf(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise)
{
  vtkInformation* information = filter->GetInputArrayInformation(index);
  Choice choice;
  choice.pointsFirst = information->Has(vtkDataObject::FIELD_ASSOCIATION()) &&
    information->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::FIELD_ASSOCIATION_POINTS;
  if (information->Has(vtkDataObject::FIELD_NAME()))
  {
    choice.name = information->Get(vtkDataObject::FIELD_NAME());
  }
  else if (information->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()))
  {
    choice.attribute = information->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE());
  }
  // The attribute SCALARS is VTK's default: the user selected nothing.
  const bool nothing =
    choice.name == NothingChosen || (choice.name.empty() && choice.attribute <= vtkDataSetAttributes::SCALARS);
  choice.made = !nothing && choice.name != otherwise;
  if (nothing)
  {
    choice.pointsFirst = otherwise.empty();
    choice.name = otherwise;
    choice.attribute = otherwise.empty() ? static_cast<int>(vtkDataSetAttributes::SCALARS) : -1;
  }
  if (image && !choice.made && choice.attribute < 0)
  {
    FollowFilterBefore(image, choice);
  }
  return choice;
}

vtkDataArray* ArrayChosenIn(vtkDataSetAttributes* attributes, const Choice& choice)
{
  return choice.attribute >= 0 ? attributes->GetAttribute(choice.attribute) : attributes->GetArray(choice.name.c_str());
}

/// Checks that the chosen array, if there is one, is numeric.
/// @throws InvalidInput if it is not
void CheckNumeric(vtkDataSetAttributes* attributes, const Choice& choice)
{
  vtkAbstractArray* array = attributes->GetAbstractArray(choice.name.c_str());
  if (choice.attribute < 0 && array && !vtkArrayDownCast<vtkDataArray>(array))
  {
    throw InvalidInput("Array " + Quoted(choice.name) + " is text; it must be of numbers.");
  }
}

Found Find(vtkImageData* image, const Choice& choice)
{
  vtkDataArray* ofCells = ArrayChosenIn(image->GetCellData(), choice);
  vtkDataArray* ofPoints = ArrayChosenIn(image->GetPointData(), choice);
  if (choice.pointsFirst ? ofPoints != nullptr : ofCells == nullptr)
  {
    return { ofPoints, true };
  }
  return { ofCells, false };
}

FloatField Read(vtkImageData* image, const Choice& choice, Need need, Components components, float empty = 0.0f)
{
  GridOf(image); // throws a specific error if the image has no cells
  const Found found = Find(image, choice);
  if (found.array)
  {
    const char* name = found.array->GetName();
    return ToField(image, found, name ? name : "", components, empty);
  }
  CheckNumeric(image->GetCellData(), choice);
  CheckNumeric(image->GetPointData(), choice);
  if (need == Need::Required || choice.made)
  {
    throw InvalidInput((choice.attribute >= 0 ? "The input has no active " +
                             std::string(vtkDataSetAttributes::GetAttributeTypeAsString(choice.attribute))
                                              : "The input has no array " + Quoted(choice.name)) +
      ". Its cell arrays: " + NamesOf(image->GetCellData()) + "; its point arrays: " + NamesOf(image->GetPointData()) +
      ".");
  }
  return {};
}
}

std::string NamesOf(vtkDataSetAttributes* attributes)
{
  std::string names;
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    const char* name = attributes->GetArrayName(i);
    names += (i > 0 ? ", " : "") + Quoted(name ? name : "");
  }
  return names.empty() ? "none" : names;
}

Grid GridOf(vtkImageData* image)
{
  Require(image, "There is no input image.");
  const char* const axes[3] = { "x", "y", "z" };
  Grid grid;
  int extent[6];
  image->GetExtent(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.size[axis] = extent[2 * axis + 1] - extent[2 * axis];
    grid.spacing[axis] = image->GetSpacing()[axis];
    if (grid.size[axis] < 0)
    {
      StopIfUpstreamFailed(image);
      throw InvalidInput("The input image is empty.");
    }
    if (grid.size[axis] == 0)
    {
      throw InvalidInput("The input image has a single layer of points along " + std::string(axes[axis]) +
        ", so no voxels; it needs at least two. It may be a picture of a volume: take the volume itself.");
    }
    if (!(grid.spacing[axis] > 0.0) || std::isinf(grid.spacing[axis]))
    {
      throw InvalidInput("The input image has spacing " + Text("%g", grid.spacing[axis]) + " along " + axes[axis] +
        "; it must be a positive number.");
    }
    grid.origin[axis] = image->GetOrigin()[axis] + extent[2 * axis] * grid.spacing[axis];
    Require(std::isfinite(grid.origin[axis]),
      "The input image has an origin that is not finite along " + std::string(axes[axis]) + ".");
  }
  Require(image->GetDirectionMatrix()->IsIdentity(),
    "The input image is sheared by its direction matrix, or turned otherwise than the medium that it belongs to, "
    "which is not supported. Resample it: with Resample of VDBReader, where it was read by that, or with "
    "ResampleToImage (Resample To Image).");
  Check(grid);
  return grid;
}

FloatField ReadCells(vtkImageData* image, const std::string& name, Need need, Components components)
{
  Choice choice;
  choice.name = name;
  return Read(image, choice, need, components);
}

FloatField ReadChosenCells(
  vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise, Need need, Components components)
{
  const float empty = otherwise == "ior" ? 1.0f : 0.0f; // value of hidden cells
  GridOf(image);
  return Read(image, ChoiceOf(filter, index, image, otherwise), need, components, empty);
}

vtkDataArray* ChosenArray(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& otherwise)
{
  return Find(image, ChoiceOf(filter, index, image, otherwise)).array;
}

void NoteChoices(vtkAlgorithm* filter, const Quantities& quantities, vtkImageData* input, vtkImageData* output)
{
  for (const auto& [index, quantity] : quantities)
  {
    const Found found = Find(input, ChoiceOf(filter, index, input, quantity));
    const char* const name = found.array ? found.array->GetName() : nullptr;
    std::vector<std::string> said = { name ? name : quantity };
    if (name && found.ofPoints && input->GetCellData()->HasArray(name))
    {
      said.emplace_back(OfPoints);
    }
    output->GetFieldData()->RemoveArray(ChoiceFact(quantity).c_str());
    if (said != std::vector<std::string>{ quantity })
    {
      AddFact(output, ChoiceFact(quantity).c_str(), said);
    }
  }
}

void ForgetChoices(vtkImageData* output)
{
  for (const char* quantity : { "sigma_a", "sigma_s", "emission" })
  {
    output->GetFieldData()->RemoveArray(ChoiceFact(quantity).c_str());
  }
}

bool IsUnusual(vtkAlgorithm* filter, int index, vtkImageData* image, const std::string& name, float usual)
{
  const Found found = Find(image, ChoiceOf(filter, index, image, name));
  if (!found.array)
  {
    return false;
  }
  const FloatField field = ToField(image, found, name, {}, usual);
  const float* const values = field.Values();
  return std::any_of(
    values, values + image->GetNumberOfCells() * field.Components(), [=](float value) { return value != usual; });
}

ArraysRead FindArrays(vtkAlgorithm* filter, const VoxelArrays& arrays, vtkImageData* image)
{
  ArraysRead read;
  const auto add = [&](const Choice& choice) {
    const Found found = Find(image, choice);
    if (found.array)
    {
      const char* const name = found.array->GetName();
      (found.ofPoints ? read.ofPoints : read.ofCells).emplace_back(name ? name : "");
    }
  };
  for (std::size_t number = 0; number < arrays.chosen.size(); ++number)
  {
    add(ChoiceOf(filter, static_cast<int>(number), image, arrays.chosen[number]));
  }
  for (const std::string& name : arrays.named)
  {
    Choice choice;
    choice.name = name;
    add(choice);
  }
  return read;
}

bool ChoosesOnlyPoints(vtkAlgorithm* filter, const std::vector<std::string>& chosen, vtkInformation* input)
{
  bool ofPoints = false, ofCells = false;
  for (std::size_t number = 0; number < chosen.size(); ++number)
  {
    const Choice choice = ChoiceOf(filter, static_cast<int>(number), nullptr, chosen[number]);
    const bool isActive = choice.attribute >= 0 &&
      vtkDataObject::GetActiveFieldInformation(input, vtkDataObject::FIELD_ASSOCIATION_POINTS, choice.attribute);
    (choice.pointsFirst ? ofPoints : ofCells) |= choice.made || isActive;
  }
  return ofPoints && !ofCells;
}

double ReadFact(vtkDataObject* data, const char* name, double missing)
{
  vtkAbstractArray* found = data->GetFieldData()->GetAbstractArray(name);
  if (!found)
  {
    return missing;
  }
  auto* numbers = vtkArrayDownCast<vtkDataArray>(found);
  Require(numbers && numbers->GetNumberOfValues() == 1, "The field data " + Quoted(name) + " must be one number.");
  return numbers->GetTuple1(0);
}

namespace
{
std::string Numbers(const std::array<double, 3>& values)
{
  return "(" + Text("%.9g", values[0]) + ", " + Text("%.9g", values[1]) + ", " + Text("%.9g", values[2]) + ")";
}

std::string Described(const Grid& grid)
{
  const std::array<int, 3>& size = grid.size;
  return std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]) +
    " voxels of spacing " + Numbers(grid.spacing) + " from origin " + Numbers(grid.origin);
}
}

bool AreSameVoxels(const Grid& a, const Grid& b)
{
  constexpr double part = 1e-3; // largest accepted distance between the grids' corresponding corners, in voxel edges
  bool agree = a.size == b.size;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = std::abs(a.origin[axis] - b.origin[axis]);
    const double high = std::abs(a.origin[axis] + a.Length(axis) - b.origin[axis] - b.Length(axis));
    agree = agree && std::max(low, high) <= part * b.spacing[axis];
  }
  return agree;
}

void CheckSameVoxels(const Grid& grid, const Grid& medium, const std::string& whose, const std::string& remedy)
{
  Require(AreSameVoxels(grid, medium),
    whose + " has " + Described(grid) + ", the medium " + Described(medium) + ". " + remedy);
}
}
