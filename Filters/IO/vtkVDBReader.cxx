#include "vtkVDBReader.h"

#include "Common/AvailableMemory.h"
#include "Common/LightTransportData.h"
#include "Device/HostMemory.h"
#include "IO/VDB/VDBCells.h"
#include "IO/VDB/VDBFile.h"
#include "IO/VDB/VDBGeometry.h"
#include "IO/VDB/VDBMetadata.h"
#include "Numerics/NumberText.h"
#include "Work/GuardedWork.h"

#include "vtkCellData.h"
#include "vtkDataArraySelection.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <set>

using tyndall::InvalidInput;
using tyndall::Text;
using tyndall::VDBBox;
using tyndall::VDBFile;
using tyndall::VDBGrid;

namespace
{
std::string ToString(const VDBBox& box)
{
  const auto corner = [](const auto& voxel) {
    return "[" + std::to_string(voxel[0]) + ", " + std::to_string(voxel[1]) + ", " + std::to_string(voxel[2]) + "]";
  };
  return corner(box.Min) + " to " + corner(box.Max);
}

std::string Bytes(double bytes)
{
  const char* units[] = { "B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB" };
  int unit = 0;
  for (; bytes >= 1024.0 && unit < 6; ++unit)
  {
    bytes /= 1024.0;
  }
  return Text(bytes >= 999.5 ? "%.4g" : "%.3g", bytes) + " " + units[unit];
}

/// Memory of an image with a grid's voxels as cells of that extent.
double BytesAsImage(const VDBGrid& grid, const std::array<std::int64_t, 6>& extent)
{
  return tyndall::CellsOf(extent) * static_cast<double>(tyndall::FindValueType(grid.Type)->Size);
}

std::string Summary(const VDBFile& file)
{
  std::string lines;
  for (const VDBGrid& grid : file.Grids())
  {
    lines += grid.Name + ": " + grid.Type + (grid.Place.Half ? " (16 bits in the file)" : "") + ", ";
    if (!grid.Unusable.empty())
    {
      lines += "not readable as an image: " + grid.Unusable + "\n";
      continue;
    }
    if (grid.Tree.ActiveBox.Empty())
    {
      lines += "no active voxels\n";
      continue;
    }
    lines += std::to_string(grid.Tree.ActiveVoxels) + " active voxels in " + ToString(grid.Tree.ActiveBox) + ", " +
      Bytes(static_cast<double>(grid.Tree.TreeBytes)) + " as a tree, " +
      Bytes(BytesAsImage(grid, tyndall::ExtentOf(grid))) + " as an image\n";
  }
  return lines;
}

/// The largest part of an image's voxels that is active in any of its grids.
double ActivePart(const std::vector<const VDBGrid*>& grids, const std::array<std::int64_t, 6>& extent)
{
  double most = 0.0;
  for (const VDBGrid* grid : grids)
  {
    most = std::max(most, static_cast<double>(grid->Tree.ActiveVoxels) / tyndall::CellsOf(extent));
  }
  return most;
}

/// Without a MaximumMemory, an image takes no more than the larger of these, bytes and bytes for each of its file,
/// unless the file notes that it was an image of that size. Clouds with a sparse outline take 10 to 300 bytes for one
/// of their file; one changed bit of a small file can say terabytes.
constexpr double SmallImage = 1073741824.0, MostOfFile = 1000.0;

openvdb::CoordBBox CellsIn(const int* extent)
{
  std::array<std::int64_t, 6> points;
  std::copy_n(extent, 6, points.begin());
  const VDBBox voxels = tyndall::VoxelsOf(points);
  openvdb::CoordBBox box;
  for (int axis = 0; axis < 3; ++axis)
  {
    box.min()[axis] = static_cast<int>(voxels.Min[axis]);
    box.max()[axis] = static_cast<int>(voxels.Max[axis]);
  }
  return box;
}

void EmptyExtent(vtkInformation* info)
{
  const int empty[6] = { 0, -1, 0, -1, 0, -1 };
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), empty, 6);
}
}

struct vtkVDBReader::Internals
{
  /// The file as last listed.
  std::unique_ptr<VDBFile> File;
  std::string Path;
  std::string Summary;
  std::set<std::string> Listed; ///< names that came into the selection from a file
  std::string OnlyGrid;         ///< set by SetGridName, not applied yet

  std::vector<const VDBGrid*> Chosen;
  tyndall::VDBGeometry Image;
  bool IsBare = false; ///< no chosen grid has an active voxel

  void List(const char* path);
  void Offer(vtkDataArraySelection* selection);
  void Choose(vtkDataArraySelection* selection);
  void CheckMemory(vtkIdType maximum) const;

  struct Limit
  {
    double Bytes;
    std::string Why;
  };
  Limit LimitOfMemory(vtkIdType maximum) const;
};

/// Anew each time: it takes milliseconds, and a file's time and length do not tell that it was written again.
void vtkVDBReader::Internals::List(const char* path)
{
  if (path == nullptr || path[0] == '\0')
  {
    throw InvalidInput("No file: set FileName.");
  }
  this->File.reset();
  this->Summary.clear();
  this->File.reset(new VDBFile(path));
  this->Path = path;
  this->Summary = ::Summary(*this->File);
}

/// Brings the file's grids into the selection. Those that share the first one's transform are chosen at first.
void vtkVDBReader::Internals::Offer(vtkDataArraySelection* selection)
{
  for (auto name = this->Listed.begin(); name != this->Listed.end();)
  {
    if (this->File->Find(*name) == nullptr)
    {
      selection->RemoveArrayByName(name->c_str());
      name = this->Listed.erase(name);
    }
    else
    {
      ++name;
    }
  }
  const VDBGrid* first = nullptr;
  for (const VDBGrid& grid : this->File->Grids())
  {
    const bool usable = grid.Unusable.empty();
    first = usable && first == nullptr ? &grid : first;
    if (!selection->ArrayExists(grid.Name.c_str()))
    {
      selection->AddArray(grid.Name.c_str(), usable && tyndall::SharesTransform(*first, grid));
      this->Listed.insert(grid.Name);
    }
  }
  if (!this->OnlyGrid.empty())
  {
    selection->DisableAllArrays();
    selection->SetArraySetting(this->OnlyGrid.c_str(), 1);
    this->OnlyGrid.clear();
  }
}

void vtkVDBReader::Internals::Choose(vtkDataArraySelection* selection)
{
  this->Chosen.clear();
  this->IsBare = false;
  this->Image = {};
  const auto& grids = this->File->Grids();
  if (std::none_of(grids.begin(), grids.end(), [](const VDBGrid& grid) { return grid.Unusable.empty(); }) &&
    selection->GetNumberOfArraysEnabled() == 0)
  {
    throw InvalidInput(grids.empty() ? "\"" + this->Path + "\" holds no grid."
                                     : "No grid of \"" + this->Path + "\" can become an image. Of \"" +
          grids.front().Name + "\", " + grids.front().Unusable + ".");
  }
  for (int i = 0; i < selection->GetNumberOfArrays(); ++i)
  {
    const std::string name = selection->GetArrayName(i);
    if (!selection->GetArraySetting(i))
    {
      continue;
    }
    const VDBGrid* grid = this->File->Find(name);
    if (grid == nullptr)
    {
      std::string available;
      for (const VDBGrid& other : this->File->Grids())
      {
        available += (available.empty() ? "\"" : ", \"") + other.Name + "\"";
      }
      throw InvalidInput("\"" + this->Path + "\" has no grid \"" + name + "\". It has " +
        (available.empty() ? "none" : available) + ".");
    }
    if (!grid->Unusable.empty())
    {
      throw InvalidInput("Grid \"" + name + "\" of \"" + this->Path + "\" cannot become an image: " + grid->Unusable +
        ", or switch it off.");
    }
    if (!this->Chosen.empty() && !tyndall::SharesTransform(*this->Chosen.front(), *grid))
    {
      throw InvalidInput("Grids \"" + this->Chosen.front()->Name + "\" and \"" + name + "\" of \"" + this->Path +
        "\" have different transforms, so one image cannot hold both. Switch one off, and read it with a second "
        "reader.");
    }
    this->Chosen.push_back(grid);
  }
  // In the order of the file, whatever the order in which they were chosen.
  std::sort(this->Chosen.begin(), this->Chosen.end());
  if (!this->Chosen.empty())
  {
    this->Image = tyndall::GeometryOf(this->Chosen);
    this->IsBare = this->Image.Empty();
  }
}

void vtkVDBReader::Internals::CheckMemory(vtkIdType maximum) const
{
  const auto& extent = this->Image.Extent;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (extent[2 * axis] < VTK_INT_MIN || extent[2 * axis + 1] > VTK_INT_MAX)
    {
      throw InvalidInput("The active voxels of \"" + this->Path + "\" reach further than VTK counts.");
    }
  }
  double image = 0.0, tree = 0.0;
  for (const VDBGrid* grid : this->Chosen)
  {
    image += BytesAsImage(*grid, extent);
    tree = std::max(tree, static_cast<double>(grid->Tree.TreeBytes));
  }
  const Limit limit = this->LimitOfMemory(maximum);
  if (image + tree > limit.Bytes)
  {
    throw InvalidInput("The chosen grids of \"" + this->Path + "\" need " + Bytes(image + tree) + " (" +
      Text("%.0f", image + tree) + " bytes) as an image of voxels " + ToString(tyndall::VoxelsOf(extent)) +
      "; the limit is " + Bytes(limit.Bytes) + limit.Why + ". Choose fewer grids, resample or crop the file, or " +
      (maximum > 0 ? "raise" : "set") + " MaximumMemory (in MiB).");
  }
}

vtkVDBReader::Internals::Limit vtkVDBReader::Internals::LimitOfMemory(vtkIdType maximum) const
{
  if (maximum > 0)
  {
    return { static_cast<double>(maximum) * 1048576.0, "" };
  }
  Limit limit = { 0.5 * static_cast<double>(tyndall::HostMemory()), ", half of this machine's memory" };
  const double available = 0.9 * tyndall::AvailableMemory();
  if (available < limit.Bytes)
  {
    limit = { available, ", of the memory that is available now" };
  }
  const double file = static_cast<double>(this->File->Size()), ofFile = std::max(SmallImage, MostOfFile * file);
  const bool noted = std::all_of(this->Chosen.begin(), this->Chosen.end(),
    [this](const VDBGrid* grid) { return tyndall::NotesExtent(*grid, this->Image.Extent); });
  if (!noted && ofFile < limit.Bytes)
  {
    limit = { ofFile,
      " for a file of " + Bytes(file) +
        " that does not come from an image of that size: a corrupt file may say so too" };
  }
  return limit;
}

vtkStandardNewMacro(vtkVDBReader);

vtkVDBReader::vtkVDBReader()
  : Internal(new Internals)
{
  this->SetNumberOfInputPorts(0);
}

vtkVDBReader::~vtkVDBReader()
{
  delete[] this->FileName;
}

int vtkVDBReader::CanReadFile(const char* fileName)
{
  return fileName != nullptr && VDBFile::HasMagic(fileName);
}

int vtkVDBReader::GetNumberOfGridArrays()
{
  return this->GridSelection->GetNumberOfArrays();
}

const char* vtkVDBReader::GetGridArrayName(int index)
{
  return this->GridSelection->GetArrayName(index);
}

int vtkVDBReader::GetGridArrayStatus(const char* name)
{
  return this->GridSelection->ArrayIsEnabled(name);
}

void vtkVDBReader::SetGridArrayStatus(const char* name, int status)
{
  this->GridSelection->SetArraySetting(name, status);
}

vtkDataArraySelection* vtkVDBReader::GetGridSelection()
{
  return this->GridSelection;
}

void vtkVDBReader::SetGridName(const char* name)
{
  this->Internal->OnlyGrid = name ? name : "";
  this->Modified();
}

const char* vtkVDBReader::GetGridSummary()
{
  return this->Internal->Summary.c_str();
}

vtkMTimeType vtkVDBReader::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->GridSelection->GetMTime());
}

int vtkVDBReader::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  Internals& internal = *this->Internal;
  internal.Chosen.clear();
  EmptyExtent(info);
  info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  const bool listed = tyndall::GuardedInformation(this, [&] {
    internal.List(this->FileName);
    internal.Offer(this->GridSelection);
    internal.Choose(this->GridSelection);
    internal.CheckMemory(this->MaximumMemory);
  });
  if (!listed)
  {
    internal.Chosen.clear();
    return 1;
  }
  if (internal.IsBare)
  {
    vtkWarningMacro("The chosen grids of \"" << internal.Path << "\" have no active voxels, so the image is empty.");
  }

  const tyndall::VDBGeometry& image = internal.Image;
  int extent[6];
  std::copy(image.Extent.begin(), image.Extent.end(), extent);
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  info->Set(vtkDataObject::ORIGIN(), image.Origin.data(), 3);
  info->Set(vtkDataObject::SPACING(), image.Spacing.data(), 3);
  info->Set(vtkDataObject::DIRECTION(), image.Direction.data(), 9);
  return 1;
}

int vtkVDBReader::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  return tyndall::Guarded(this, outputs, [&] {
    vtkInformation* info = outputs->GetInformationObject(0);
    vtkImageData* image = vtkImageData::GetData(info);
    image->Initialize();
    Internals& internal = *this->Internal;
    int extent[6];
    info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent);
    if (internal.Chosen.empty() || extent[0] > extent[1] || extent[2] > extent[3] || extent[4] > extent[5])
    {
      return;
    }
    const tyndall::VDBGeometry& geometry = internal.Image;
    image->SetExtent(extent);
    image->SetOrigin(geometry.Origin.data());
    image->SetSpacing(geometry.Spacing.data());
    image->SetDirectionMatrix(geometry.Direction.data());

    const openvdb::CoordBBox box = CellsIn(extent);
    double done = 0.0;
    for (const VDBGrid* grid : internal.Chosen)
    {
      if (this->GetAbortExecute())
      {
        throw tyndall::Aborted();
      }
      tyndall::AddGridCells(*internal.File->Read(*grid, box), grid->Type, grid->Name, box, image);
      tyndall::AddMetadata(image, tyndall::FieldName(grid->Name, ""), grid->Metadata);
      this->UpdateProgress(++done / static_cast<double>(internal.Chosen.size()));
    }
    tyndall::AddMetadata(image, tyndall::FieldName("", ""), internal.File->Metadata());
    tyndall::AddFact(
      image, tyndall::ActivePartFact, std::vector<double>{ ActivePart(internal.Chosen, geometry.Extent) });
    tyndall::AddMediumFacts(image, internal.File->Metadata());
    image->GetCellData()->SetActiveScalars(internal.Chosen.front()->Name.c_str());
  });
}

void vtkVDBReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "MaximumMemory: " << this->MaximumMemory << "\n";
  os << indent << "GridSelection:\n";
  this->GridSelection->PrintSelf(os, indent.GetNextIndent());
}
