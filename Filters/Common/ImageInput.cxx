#include "Common/ImageInput.h"

#include "Common/LightTransportData.h"
#include "Device/Errors.h"
#include "PropertyRange.h"

#include "vtkAbstractArray.h"
#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleKey.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationStringKey.h"
#include "vtkInformationStringVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
/// Of a port: that it is for images, whatever it takes.
vtkInformationIntegerKey* ForImages()
{
  static auto* const key = vtkInformationIntegerKey::MakeKey("FOR_IMAGES", "Tyndall");
  return key;
}

/// Of a port: names of the arrays that are read of its image.
vtkInformationStringVectorKey* ChosenArrays()
{
  static auto* const key = vtkInformationStringVectorKey::MakeKey("CHOSEN_ARRAYS", "Tyndall");
  return key;
}

vtkInformationStringVectorKey* NamedArrays()
{
  static auto* const key = vtkInformationStringVectorKey::MakeKey("NAMED_ARRAYS", "Tyndall");
  return key;
}

/// Of a filter.
vtkInformationStringKey* AveragedArrays()
{
  static auto* const key = vtkInformationStringKey::MakeKey("AVERAGED_ARRAYS", "Tyndall");
  return key;
}

std::vector<std::string> TextsOf(vtkInformation* port, vtkInformationStringVectorKey* key)
{
  std::vector<std::string> texts;
  for (int i = 0; i < port->Length(key); ++i)
  {
    texts.emplace_back(port->Get(key, i));
  }
  return texts;
}

bool HasArrays(vtkDataSetAttributes* attributes)
{
  const int flags = attributes->HasArray(vtkDataSetAttributes::GhostArrayName()) ? 1 : 0;
  return attributes->GetNumberOfArrays() > flags;
}

/// Flags of points as those of the voxels around them.
void FlagVoxels(vtkImageData* points, vtkImageData* voxels)
{
  const char* const name = vtkDataSetAttributes::GhostArrayName();
  voxels->GetCellData()->RemoveArray(name);
  vtkUnsignedCharArray* const given = points->GetPointGhostArray();
  if (!given)
  {
    return;
  }
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(name);
  flags->SetNumberOfTuples(given->GetNumberOfTuples());
  std::transform(given->GetPointer(0), given->GetPointer(0) + given->GetNumberOfTuples(), flags->GetPointer(0),
    [](unsigned char flag) -> unsigned char {
      return (flag & vtkDataSetAttributes::DUPLICATEPOINT ? vtkDataSetAttributes::DUPLICATECELL : 0) |
        (flag & vtkDataSetAttributes::HIDDENPOINT ? vtkDataSetAttributes::HIDDENCELL : 0);
    });
  voxels->GetCellData()->AddArray(flags);
}

/// Where the outermost corner of the voxel around point 0 is.
std::array<double, 3> CornerBefore(const double* origin, const double* spacing, const double* direction)
{
  std::array<double, 3> corner;
  for (int row = 0; row < 3; ++row)
  {
    corner[row] = origin[row];
    for (int axis = 0; axis < 3; ++axis)
    {
      corner[row] -= 0.5 * direction[3 * row + axis] * spacing[axis];
    }
  }
  return corner;
}

constexpr double Aslant = 1e-6; ///< a direction that is further from all axes is along none

/// Numbers of the values of an image, cells or points, in the order of the aligned one.
/// @param count  of values along the axes of the image
vtkSmartPointer<vtkIdList> OrderOf(const AxisWays& ways, const std::array<vtkIdType, 3>& count)
{
  const std::array<vtkIdType, 3> stride = { 1, count[0], count[0] * count[1] };
  std::array<vtkIdType, 3> counts, first, step; // along the world's axes
  for (int axis = 0; axis < 3; ++axis)
  {
    const int world = ways.world[axis];
    counts[world] = count[axis];
    first[world] = ways.down[axis] ? (count[axis] - 1) * stride[axis] : 0;
    step[world] = ways.down[axis] ? -stride[axis] : stride[axis];
  }
  auto order = vtkSmartPointer<vtkIdList>::New();
  order->SetNumberOfIds(count[0] * count[1] * count[2]);
  vtkIdType* to = order->GetPointer(0);
  for (vtkIdType k = 0; k < counts[2]; ++k)
  {
    for (vtkIdType j = 0; j < counts[1]; ++j)
    {
      const vtkIdType row = first[0] + first[1] + first[2] + k * step[2] + j * step[1];
      for (vtkIdType i = 0; i < counts[0]; ++i)
      {
        *to++ = row + i * step[0];
      }
    }
  }
  return order;
}

void CopyInOrder(vtkDataSetAttributes* from, vtkIdList* order, vtkDataSetAttributes* to)
{
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* const values = from->GetAbstractArray(i);
    if (values->GetNumberOfTuples() != order->GetNumberOfIds())
    {
      continue;
    }
    const auto ordered = vtkSmartPointer<vtkAbstractArray>::Take(values->NewInstance());
    ordered->SetName(values->GetName());
    ordered->SetNumberOfComponents(values->GetNumberOfComponents());
    ordered->SetNumberOfTuples(order->GetNumberOfIds());
    values->GetTuples(order, ordered);
    to->AddArray(ordered);
  }
  vtkDataArray* const active = from->GetScalars();
  if (active && active->GetName())
  {
    to->SetActiveScalars(active->GetName());
  }
}

/// As far as is known before the image.
bool MayBeAroundPoints(vtkAlgorithm* filter, int port, vtkInformation* input)
{
  auto* const image = vtkImageData::SafeDownCast(vtkDataObject::GetData(input));
  if (image && image->GetNumberOfPoints() > 0 && (HasArrays(image->GetCellData()) || HasArrays(image->GetPointData())))
  {
    return AreAroundPoints(filter, port, image);
  }
  const VoxelArrays arrays = VoxelArraysOf(filter->GetInputPortInformation(port));
  return PointDataOf(filter) == VoxelsAroundPoints && ChoosesOnlyPoints(filter, arrays.chosen, input);
}

/// @return which filters of ParaView make an image of such data, as what they do
std::string HowToMakeAnImage(vtkDataObject* data)
{
  const std::string resample = "ResampleToImage (Resample To Image)";
  if (data->IsA("vtkTable"))
  {
    return "The filters TableToStructuredGrid (Table To Structured Grid) and then " + resample + " make one of it.";
  }
  if (data->IsA("vtkHyperTreeGrid"))
  {
    return "The filters HyperTreeGridToUnstructuredGrid (HyperTreeGrid To UnstructuredGrid) and then " + resample +
      " make one of it.";
  }
  if (data->IsA("vtkPolyData"))
  {
    return "The filter MeshVoxelizer (Mesh Voxelizer) makes a medium of a closed mesh, PointVolumeInterpolator (Point "
           "Volume Interpolator) an image of points, and " +
      resample + " one of cells that have a volume.";
  }
  return "The filter " + resample + " makes one of it.";
}
}

void TakeImages(vtkInformation* port)
{
  port->Set(ForImages(), 1);
  port->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  for (const char* type : { "vtkDataSet", "vtkUniformGridAMR", "vtkHyperTreeGrid", "vtkTable", "vtkGraph" })
  {
    port->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), type);
  }
}

void TakeOneImage(vtkInformation* port)
{
  port->Set(ForImages(), 1);
  port->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
}

void RequireImages(vtkAlgorithm* filter)
{
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    if (!filter->GetInputPortInformation(port)->Has(ForImages()) || filter->GetNumberOfInputConnections(port) == 0)
    {
      continue;
    }
    vtkDataObject* const input = filter->GetInputDataObject(port, 0);
    if (input && !vtkImageData::SafeDownCast(input))
    {
      throw InvalidInput("The input" + (port > 0 ? " " + std::to_string(port) : std::string()) + " is a " +
        input->GetClassName() + "; it must be an image, vtkImageData. " + HowToMakeAnImage(input));
    }
  }
}

namespace
{
/// @throws InvalidInput where an array of these has not a value for each of `count` points, cells or rows
void RequireAsLong(vtkDataSetAttributes* arrays, vtkIdType count, const std::string& elements, const std::string& input)
{
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* const array = arrays->GetAbstractArray(i);
    if (array->GetNumberOfTuples() != count)
    {
      const std::string name = array->GetName() ? array->GetName() : "";
      throw InvalidInput("Array '" + name + "' has " + std::to_string(array->GetNumberOfTuples()) +
        " values where the dataset has " + std::to_string(count) + " " + elements + " (" + input +
        "). Give each of them a value, or leave the array out.");
    }
  }
}
}

void RequireWholeArrays(vtkAlgorithm* filter)
{
  const std::pair<int, const char*> kinds[] = { { vtkDataObject::POINT, "points" }, { vtkDataObject::CELL, "cells" },
    { vtkDataObject::ROW, "rows" } };
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < filter->GetNumberOfInputConnections(port); ++i)
    {
      vtkDataObject* const input = filter->GetInputDataObject(port, i);
      for (const auto& [kind, elements] : kinds)
      {
        if (vtkDataSetAttributes* const arrays = input ? input->GetAttributes(kind) : nullptr)
        {
          RequireAsLong(arrays, input->GetNumberOfElements(kind), elements,
            "input " + std::to_string(port) + ", " + input->GetClassName());
        }
      }
    }
  }
}

void ReadsVoxels(
  vtkInformation* port, std::initializer_list<const char*> chosen, std::initializer_list<const char*> named)
{
  port->Remove(ChosenArrays());
  port->Remove(NamedArrays());
  std::for_each(chosen.begin(), chosen.end(), [&](const char* name) { port->Append(ChosenArrays(), name); });
  std::for_each(named.begin(), named.end(), [&](const char* name) { port->Append(NamedArrays(), name); });
}

VoxelArrays VoxelArraysOf(vtkInformation* port)
{
  return { TextsOf(port, ChosenArrays()), TextsOf(port, NamedArrays()) };
}

bool AreAroundPoints(vtkAlgorithm* filter, int port, vtkImageData* image, std::vector<std::string>* averaged)
{
  const VoxelArrays arrays = VoxelArraysOf(filter->GetInputPortInformation(port));
  if (!image || image->GetNumberOfPoints() == 0 || (arrays.chosen.empty() && arrays.named.empty()) ||
    PointDataOf(filter) == AverageToCells)
  {
    return false;
  }
  const ArraysRead read = FindArrays(filter, arrays, image);
  if (averaged && !read.ofCells.empty())
  {
    *averaged = read.ofPoints;
  }
  const bool any = std::find(arrays.named.begin(), arrays.named.end(), AnyArray) != arrays.named.end();
  const bool onlyPoints = any && !HasArrays(image->GetCellData()) && HasArrays(image->GetPointData());
  return read.ofCells.empty() && (!read.ofPoints.empty() || onlyPoints);
}

vtkSmartPointer<vtkImageData> VoxelsAround(vtkImageData* points)
{
  auto voxels = vtkSmartPointer<vtkImageData>::New();
  int extent[6];
  points->GetExtent(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    ++extent[2 * axis + 1];
  }
  voxels->SetExtent(extent);
  voxels->SetSpacing(points->GetSpacing());
  voxels->SetDirectionMatrix(points->GetDirectionMatrix());
  voxels->SetOrigin(
    CornerBefore(points->GetOrigin(), points->GetSpacing(), points->GetDirectionMatrix()->GetData()).data());
  voxels->GetCellData()->ShallowCopy(points->GetPointData());
  FlagVoxels(points, voxels);
  voxels->SetFieldData(points->GetFieldData());
  voxels->GetInformation()->CopyEntry(points->GetInformation(), vtkDataObject::DATA_TIME_STEP());
  return voxels;
}

bool AxisWays::AreAlike() const
{
  return this->world == std::array<int, 3>{ 0, 1, 2 } && this->down == std::array<bool, 3>{};
}

std::array<int, 6> AxisWays::Extent(const int* ofImage) const
{
  std::array<int, 6> extent;
  const bool any = ofImage[0] <= ofImage[1] && ofImage[2] <= ofImage[3] && ofImage[4] <= ofImage[5];
  for (int axis = 0; axis < 3; ++axis)
  {
    const int low = ofImage[2 * axis], high = ofImage[2 * axis + 1];
    const bool turned = any && this->down[axis];
    extent[2 * this->world[axis]] = turned ? -high : low;
    extent[2 * this->world[axis] + 1] = turned ? -low : high;
  }
  return extent;
}

std::optional<AxisWays> WaysOf(const double* spacing, const double* direction)
{
  AxisWays ways;
  for (int axis = 0; axis < 3; ++axis)
  {
    int along = -1;
    for (int row = 0; row < 3; ++row)
    {
      const double cosine = direction ? direction[3 * row + axis] : row == axis ? 1.0 : 0.0;
      if (std::abs(std::abs(cosine) - 1.0) <= Aslant)
      {
        along = row;
        ways.down[axis] = (cosine < 0.0) != (spacing[axis] < 0.0);
      }
      else if (!(std::abs(cosine) <= Aslant))
      {
        return std::nullopt;
      }
    }
    if (along < 0 || !(std::abs(spacing[axis]) > 0.0) || std::isinf(spacing[axis]))
    {
      return std::nullopt;
    }
    ways.world[axis] = along;
    ways.spacing[along] = std::abs(spacing[axis]);
  }
  const bool each = ways.world[0] + ways.world[1] + ways.world[2] == 3 && ways.world[0] != ways.world[1];
  return each ? std::optional<AxisWays>(ways) : std::nullopt;
}

vtkSmartPointer<vtkImageData> Aligned(vtkImageData* image)
{
  const double* const direction = image->GetDirectionMatrix()->GetData();
  const std::optional<AxisWays> ways = WaysOf(image->GetSpacing(), direction);
  if (!ways || image->GetNumberOfPoints() == 0 || (ways->AreAlike() && image->GetDirectionMatrix()->IsIdentity()))
  {
    return image;
  }
  auto aligned = vtkSmartPointer<vtkImageData>::New();
  std::array<vtkIdType, 3> points, cells;
  for (int axis = 0; axis < 3; ++axis)
  {
    points[axis] = image->GetDimensions()[axis];
    cells[axis] = std::max<vtkIdType>(points[axis] - 1, 1);
  }
  aligned->SetExtent(ways->Extent(image->GetExtent()).data());
  aligned->SetOrigin(image->GetOrigin());
  aligned->SetSpacing(ways->spacing.data());
  CopyInOrder(image->GetCellData(), OrderOf(*ways, cells), aligned->GetCellData());
  CopyInOrder(image->GetPointData(), OrderOf(*ways, points), aligned->GetPointData());
  aligned->SetFieldData(image->GetFieldData());
  aligned->GetInformation()->CopyEntry(image->GetInformation(), vtkDataObject::DATA_TIME_STEP());
  return aligned;
}

void NoteAveraged(vtkAlgorithm* filter, const std::vector<std::string>& arrays)
{
  std::string names;
  for (const std::string& name : arrays)
  {
    names += (names.empty() ? "'" : ", '") + name + "'";
  }
  filter->GetInformation()->Set(AveragedArrays(), names.c_str());
}

void AddAveraged(vtkAlgorithm* filter, std::vector<std::string>& settings)
{
  const char* const names = filter->GetInformation()->Get(AveragedArrays());
  if (names && names[0] != '\0')
  {
    settings.push_back("PointData = 1 for " + std::string(names) + ", beside arrays of cells");
  }
}

void TellVoxels(vtkAlgorithm* filter, int port, vtkInformationVector* inputs, vtkInformationVector* outputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* const input = inputs->GetInformationObject(0);
  if (!input)
  {
    return;
  }
  std::array<int, 6> told = { 0, 1, 0, 1, 0, 1 };
  const bool isKnown = input->Has(Pipeline::WHOLE_EXTENT()) != 0;
  if (isKnown)
  {
    input->Get(Pipeline::WHOLE_EXTENT(), told.data());
  }
  const double* const spacing = input->Get(vtkDataObject::SPACING());
  const double* const origin = input->Get(vtkDataObject::ORIGIN());
  const auto ways = spacing ? WaysOf(spacing, input->Get(vtkDataObject::DIRECTION())) : std::nullopt;
  std::array<int, 6> extent = ways ? ways->Extent(told.data()) : told;
  const bool around = isKnown && told[0] <= told[1] && MayBeAroundPoints(filter, port, input);
  for (int axis = 0; axis < 3 && around; ++axis)
  {
    ++extent[2 * axis + 1];
  }
  for (int i = 0; i < outputs->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* const output = outputs->GetInformationObject(i);
    const int* const copied = output->Get(Pipeline::WHOLE_EXTENT());
    if (copied ? !isKnown || !std::equal(told.begin(), told.end(), copied) : isKnown)
    {
      continue; // it has no voxels, or others
    }
    output->Set(Pipeline::WHOLE_EXTENT(), extent.data(), 6);
    if (ways && origin)
    {
      const double aligned[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
      const auto corner = CornerBefore(origin, ways->spacing.data(), aligned);
      output->Set(vtkDataObject::ORIGIN(), around ? corner.data() : origin, 3);
      output->Set(vtkDataObject::SPACING(), ways->spacing.data(), 3);
      output->Set(vtkDataObject::DIRECTION(), aligned, 9);
    }
  }
}
}
