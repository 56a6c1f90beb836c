#include "Common/ImageInput.h"

#include "Common/ArrayRanges.h"
#include "Common/InputsKey.h"
#include "Common/LightTransportData.h"
#include "Device/Errors.h"
#include "Device/HostThreads.h"
#include "PropertyRange.h"

#include "vtkAbstractArray.h"
#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleKey.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationExecutivePortKey.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationStringKey.h"
#include "vtkInformationStringVectorKey.h"
#include "vtkInformationUnsignedLongKey.h"
#include "vtkInformationVector.h"
#include "vtkMatrix3x3.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <utility>

namespace tyndall
{
namespace
{
/// Key in a port's information: the port's images are pictures, which have no position in the scene (TakePictures).
vtkInformationIntegerKey* ForPictures()
{
  static auto* const key = vtkInformationIntegerKey::MakeKey("FOR_PICTURES", "Tyndall");
  return key;
}

/// Key in a port's information: the port is for images (TakeImages), although it accepts any data.
vtkInformationIntegerKey* ForImages()
{
  static auto* const key = vtkInformationIntegerKey::MakeKey("FOR_IMAGES", "Tyndall");
  return key;
}

/// Key in an image's information: its cells are voxels around the points of another image (PointsAsVoxels).
vtkInformationIntegerKey* AroundPoints()
{
  static auto* const key = vtkInformationIntegerKey::MakeKey("AROUND_POINTS", "Tyndall");
  return key;
}

/// Key in a port's information: names of the arrays that the filter reads from the image at this port (ReadsVoxels).
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

/// Key in a filter's information: names of point arrays that the filter averages to cells (NoteAveraged).
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

/// Converts vtkGhostType of points to vtkGhostType of the voxels around these points.
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

/// World position of the corner with the lowest indices of the voxel around point 0.
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

/// Whether an image may be read with one voxel around each point (AreAroundPoints). Decided from announced information,
/// before the image exists.
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

std::string NameOfInput(int port)
{
  return "The input" + (port > 0 ? " " + std::to_string(port) : std::string());
}

/// Advice for data that are no image.
/// @return a sentence naming filters of ParaView that convert data of this type to an image
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

void TakePictures(vtkInformation* port)
{
  port->Set(ForPictures(), 1);
}

bool TakesPictures(vtkInformation* port)
{
  return port->Has(ForPictures()) != 0;
}

bool IsForImagesOfScene(vtkInformation* port)
{
  return port->Has(ForImages()) && !TakesPictures(port);
}

void TakeOneImage(vtkInformation* port)
{
  port->Set(ForImages(), 1);
  port->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
}

namespace
{
/// Whether vtkCompositeDataPipeline runs the filter for each block of the data at a port. If several inputs have
/// blocks, the pipeline iterates over the first and refuses the others.
bool IsTakenByBlocks(vtkAlgorithm* filter, int port, vtkDataObject* input)
{
  vtkInformation* const information = filter->GetInputPortInformation(port);
  bool taken = filter->GetNumberOfInputConnections(port) == 1 && vtkCompositeDataSet::SafeDownCast(input);
  for (int i = 0; taken && i < information->Length(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE()); ++i)
  {
    taken = !input->IsA(information->Get(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), i));
  }
  return taken;
}

/// Counts the blocks of composite data that an input port processes.
/// @return number of blocks; in a port for images, blocks of other types are errors and not counted
int CountBlocks(vtkCompositeDataSet* composite, vtkInformation* port)
{
  int count = 0;
  const auto blocks = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
  for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem())
  {
    const bool isImage = vtkImageData::SafeDownCast(blocks->GetCurrentDataObject()) != nullptr;
    count += isImage || !port->Has(ForImages()) ? 1 : 0;
  }
  return count;
}

/// Text for the warning that a filter runs separately for each block of an input. It states the consequence, and names
/// a filter of ParaView that avoids it.
std::string AboutBlocks(vtkInformation* port)
{
  if (IsForImagesOfScene(port))
  {
    return "Each is lit as if it were alone: no light goes from one to another. To light them together, make one image "
           "of them before: the filter ResampleToImage (Resample To Image) does.";
  }
  if (port->Has(ForImages()))
  {
    return "The light is computed once for each of them. The filter ExtractBlock (Extract Block) chooses one.";
  }
  return "The light is computed once for each of them alone. To have it of all together, make one dataset of them "
         "before: the filter LightGroup (Light Group) does so with lights.";
}
}

void WarnOfBlocks(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** inputs)
{
  vtkMultiProcessController* const ranks = vtkMultiProcessController::GetGlobalController();
  // REQUEST_DATA_NOT_GENERATED comes once, with the complete input, before the REQUEST_DATA requests for the blocks.
  if (!request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_NOT_GENERATED()) || (ranks && ranks->GetLocalProcessId() > 0))
  {
    return;
  }
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    vtkDataObject* const input = vtkDataObject::GetData(inputs[port]);
    if (input && IsTakenByBlocks(filter, port, input))
    {
      vtkInformation* const information = filter->GetInputPortInformation(port);
      if (const int count = CountBlocks(vtkCompositeDataSet::SafeDownCast(input), information); count > 1)
      {
        vtkWarningWithObjectMacro(filter, << NameOfInput(port) << " is a " << input->GetClassName() << " of " << count
                                          << " blocks. " << AboutBlocks(information));
      }
      return;
    }
  }
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
      throw InvalidInput(NameOfInput(port) + " is a " + input->GetClassName() +
        "; it must be an image, vtkImageData. " + HowToMakeAnImage(input));
    }
  }
}

namespace
{
/// Checks the lengths of arrays.
/// @throws InvalidInput if an array does not have one tuple for each of `count` points, cells or rows
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
      auto* const image = vtkImageData::SafeDownCast(input);
      // An image that VTK has cropped to no points may still have its old arrays.
      const bool isCutToNothing = image && image->GetNumberOfPoints() == 0;
      for (const auto& [kind, elements] : kinds)
      {
        if (vtkDataSetAttributes* const arrays = input && !isCutToNothing ? input->GetAttributes(kind) : nullptr)
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

namespace
{
/// Whether the cell arrays of the medium at port 0 are read, and the medium has as many points along each axis as
/// `image`, the image at another port.
bool MediumHasCellsBetween(vtkAlgorithm* filter, vtkImageData* image)
{
  const bool any = filter->GetNumberOfInputConnections(0) > 0;
  auto* const medium = any ? vtkImageData::SafeDownCast(filter->GetInputDataObject(0, 0)) : nullptr;
  return medium && std::equal(medium->GetDimensions(), medium->GetDimensions() + 3, image->GetDimensions()) &&
    !AreAroundPoints(filter, 0, medium);
}
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
  const bool areAround = read.ofCells.empty() && (!read.ofPoints.empty() || onlyPoints);
  if (areAround && port > 0 && MediumHasCellsBetween(filter, image))
  {
    if (averaged)
    {
      *averaged = read.ofPoints;
    }
    return false;
  }
  return areAround;
}

vtkSmartPointer<vtkImageData> PointsAsVoxels(vtkImageData* points)
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
  voxels->GetInformation()->Set(AroundPoints(), 1);
  return voxels;
}

bool AreMadeAroundPoints(vtkImageData* voxels)
{
  return voxels->GetInformation()->Has(AroundPoints()) != 0;
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

namespace
{
/// The direction matrix of an image before the image exists. VTK's filters announce origin and spacing of an image, but
/// not its direction matrix, which only the image itself has. Therefore the direction announced further upstream is
/// used, unless a filter on the way makes a new image or is an imaging filter (vtkImageAlgorithm), which drops
/// directions.
/// @return null: the unit matrix
const double* DirectionTold(vtkInformation* input)
{
  while (input && !input->Has(vtkDataObject::DIRECTION()))
  {
    vtkExecutive* const producer = vtkExecutive::PRODUCER()->GetExecutive(input);
    vtkAlgorithm* const filter = producer ? producer->GetAlgorithm() : nullptr;
    const bool passes = filter && filter->GetNumberOfInputPorts() > 0 && filter->GetNumberOfInputConnections(0) > 0 &&
      !filter->IsA("vtkImageAlgorithm") && !filter->IsA("vtkResampleToImage");
    input = passes ? producer->GetInputInformation(0, 0) : nullptr;
  }
  return input ? input->Get(vtkDataObject::DIRECTION()) : nullptr;
}
}

void TellVoxels(vtkAlgorithm* filter, int port, vtkInformationVector* inputs, vtkInformationVector* outputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* const input = inputs->GetInformationObject(0);
  if (!input || IsTakenByBlocks(filter, port, vtkDataObject::GetData(input)))
  {
    return; // no extent is announced for composite data: each block has its own voxels
  }
  std::array<int, 6> told = { 0, 1, 0, 1, 0, 1 };
  const bool isKnown = input->Has(Pipeline::WHOLE_EXTENT()) != 0;
  if (isKnown)
  {
    input->Get(Pipeline::WHOLE_EXTENT(), told.data());
  }
  const double* const spacing = input->Get(vtkDataObject::SPACING());
  const double* const origin = input->Get(vtkDataObject::ORIGIN());
  const double* const direction = DirectionTold(input);
  const auto ways = spacing ? WaysOf(spacing, direction) : std::nullopt;
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
      continue; // this output has no voxels, or not those of the input
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
    else if (around && spacing && origin && direction)
    {
      output->Set(vtkDataObject::ORIGIN(), CornerBefore(origin, spacing, direction).data(), 3);
    }
  }
}

namespace
{
vtkUnsignedCharArray* Flags(vtkDataSetAttributes* attributes, vtkIdType count)
{
  auto* const flags =
    vtkArrayDownCast<vtkUnsignedCharArray>(attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  return flags && flags->GetNumberOfTuples() == count && flags->GetNumberOfComponents() == 1 ? flags : nullptr;
}

bool Any(vtkUnsignedCharArray* flags, unsigned char flag)
{
  const unsigned char* const values = flags ? flags->GetPointer(0) : nullptr;
  return flags &&
    std::any_of(values, values + flags->GetNumberOfTuples(), [=](unsigned char value) { return (value & flag) != 0; });
}

/// Flags as hidden all cells of which `point` is a corner.
void HideAround(vtkImageData* image, vtkIdType point, std::vector<unsigned char>& hidden)
{
  int points[3];
  image->GetDimensions(points);
  const std::array<vtkIdType, 3> at = { point % points[0], point / points[0] % points[1],
    point / points[0] / points[1] };
  const std::array<vtkIdType, 3> cells = { std::max(points[0] - 1, 1), std::max(points[1] - 1, 1),
    std::max(points[2] - 1, 1) };
  for (vtkIdType corner = 0; corner < 8; ++corner)
  {
    const vtkIdType i = at[0] - (corner & 1), j = at[1] - (corner >> 1 & 1), k = at[2] - (corner >> 2);
    if (i >= 0 && i < cells[0] && j >= 0 && j < cells[1] && k >= 0 && k < cells[2])
    {
      hidden[static_cast<std::size_t>((k * cells[1] + j) * cells[0] + i)] = 1;
    }
  }
}
}

std::vector<unsigned char> HiddenCells(vtkImageData* image)
{
  vtkUnsignedCharArray* const ofCells = Flags(image->GetCellData(), image->GetNumberOfCells());
  vtkUnsignedCharArray* const ofPoints = Flags(image->GetPointData(), image->GetNumberOfPoints());
  const bool cellsHidden = Any(ofCells, vtkDataSetAttributes::HIDDENCELL);
  const bool pointsHidden = Any(ofPoints, vtkDataSetAttributes::HIDDENPOINT);
  if (!cellsHidden && !pointsHidden)
  {
    return {};
  }
  std::vector<unsigned char> hidden(static_cast<std::size_t>(image->GetNumberOfCells()), 0);
  for (vtkIdType i = 0; cellsHidden && i < image->GetNumberOfCells(); ++i)
  {
    hidden[static_cast<std::size_t>(i)] = ofCells->GetValue(i) & vtkDataSetAttributes::HIDDENCELL;
  }
  for (vtkIdType i = 0; pointsHidden && i < image->GetNumberOfPoints(); ++i)
  {
    if (ofPoints->GetValue(i) & vtkDataSetAttributes::HIDDENPOINT)
    {
      HideAround(image, i, hidden);
    }
  }
  return hidden;
}

std::vector<long long> PointsThatCount(vtkPolyData* data)
{
  constexpr unsigned char leftOut = vtkDataSetAttributes::HIDDENPOINT | vtkDataSetAttributes::DUPLICATEPOINT;
  vtkUnsignedCharArray* const flags = Flags(data->GetPointData(), data->GetNumberOfPoints());
  std::vector<long long> points;
  points.reserve(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    if (!flags || (flags->GetValue(i) & leftOut) == 0)
    {
      points.push_back(i);
    }
  }
  return points;
}

void CheckDuplicates(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  auto* const pieces = vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES();
  if (filter->IsA("vtkParticipatingMedium"))
  {
    return; // this filter works cell by cell: a duplicate (ghost cell) gets the same medium as the cell that it copies
  }
  bool divided = false;
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* const information = outputs->GetInformationObject(port);
    divided = divided || (information->Has(pieces) && information->Get(pieces) > 1);
  }
  for (int port = 0; divided && port < filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < filter->GetNumberOfInputConnections(port); ++i)
    {
      auto* const image = vtkImageData::SafeDownCast(filter->GetInputDataObject(port, i));
      Require(
        !image || !Any(Flags(image->GetCellData(), image->GetNumberOfCells()), vtkDataSetAttributes::DUPLICATECELL),
        "Cells of the input image are marked as duplicates of another rank's (vtkGhostType). Light "
        "crosses the borders of pieces, so every rank works on the whole image, and would count them twice. "
        "Give it the whole image on every rank, without ghost cells.");
    }
  }
}
}
