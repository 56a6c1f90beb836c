#include "Common/ImageInput.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
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
#include <string>

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

/// As far as is known before the image.
bool MayBeAroundPoints(vtkAlgorithm* filter, int port, vtkDataObject* before)
{
  auto* const image = vtkImageData::SafeDownCast(before);
  if (image && image->GetNumberOfPoints() > 0 && (HasArrays(image->GetCellData()) || HasArrays(image->GetPointData())))
  {
    return AreAroundPoints(filter, port, image);
  }
  const VoxelArrays arrays = VoxelArraysOf(filter->GetInputPortInformation(port));
  return PointDataOf(filter) == VoxelsAroundPoints && ChoosesOnlyPoints(filter, static_cast<int>(arrays.chosen.size()));
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
  int told[6] = { 0, 1, 0, 1, 0, 1 };
  const bool isKnown = input->Has(Pipeline::WHOLE_EXTENT()) != 0;
  if (isKnown)
  {
    input->Get(Pipeline::WHOLE_EXTENT(), told);
  }
  const bool around = isKnown && told[0] <= told[1] && MayBeAroundPoints(filter, port, vtkDataObject::GetData(input));
  for (int i = 0; i < outputs->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* const output = outputs->GetInformationObject(i);
    const int* const copied = output->Get(Pipeline::WHOLE_EXTENT());
    if (!isKnown && !copied)
    {
      output->Set(Pipeline::WHOLE_EXTENT(), told, 6);
    }
    else if (around && copied && std::equal(told, told + 6, copied))
    {
      const int voxels[6] = { told[0], told[1] + 1, told[2], told[3] + 1, told[4], told[5] + 1 };
      output->Set(Pipeline::WHOLE_EXTENT(), voxels, 6);
      const double aligned[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
      const double* const direction = input->Get(vtkDataObject::DIRECTION());
      if (input->Has(vtkDataObject::ORIGIN()) && input->Has(vtkDataObject::SPACING()))
      {
        const auto corner = CornerBefore(
          input->Get(vtkDataObject::ORIGIN()), input->Get(vtkDataObject::SPACING()), direction ? direction : aligned);
        output->Set(vtkDataObject::ORIGIN(), corner.data(), 3);
      }
    }
  }
}
}
