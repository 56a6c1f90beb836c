#include "vtkVDBReader.h"

#include "Common/AvailableMemory.h"
#include "Common/Failure.h"
#include "Common/ImageInput.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Device/HostMemory.h"
#include "IO/VDB/VDBCells.h"
#include "IO/VDB/VDBFile.h"
#include "IO/VDB/VDBGeometry.h"
#include "IO/VDB/VDBMetadata.h"
#include "Numerics/NumberText.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/UpdateExtent.h"

#include "vtkCellData.h"
#include "vtkCompositeDataPipeline.h"
#include "vtkDataArraySelection.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <numeric>
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

/// Memory of an image of this extent that has one grid's values as a cell array, bytes.
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

/// Largest fraction of an image's voxels that are active in one of the grids.
double ActivePart(const std::vector<const VDBGrid*>& grids, const std::array<std::int64_t, 6>& extent)
{
  double most = 0.0;
  for (const VDBGrid* grid : grids)
  {
    most = std::max(most, static_cast<double>(grid->Tree.ActiveVoxels) / tyndall::CellsOf(extent));
  }
  return most;
}

/// Default limit of an image's memory, bytes: the larger of SmallImage and MostOfFile times the length of the file. The
/// limit does not apply if the file's metadata record that it was made from an image of that size. Images of sparse
/// clouds need 10 to 300 bytes per byte of their file; a single changed bit in a small file can demand terabytes.
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

using Pipeline = vtkStreamingDemandDrivenPipeline;
constexpr int NoExtent[6] = { 0, -1, 0, -1, 0, -1 };

std::array<int, 6> WholeExtentOf(const tyndall::VDBGeometry& image)
{
  std::array<int, 6> extent;
  std::transform(image.Extent.begin(), image.Extent.end(), extent.begin(),
    [](std::int64_t bound) { return static_cast<int>(bound); });
  return extent;
}

/// Announces time steps: none for one file; for a series, the index of each file is its time.
void TellTimes(vtkInformation* info, int files)
{
  if (files < 2)
  {
    info->Remove(Pipeline::TIME_STEPS());
    info->Remove(Pipeline::TIME_RANGE());
    info->Remove(Pipeline::TIME_DEPENDENT_INFORMATION());
    return;
  }
  std::vector<double> times(static_cast<std::size_t>(files));
  std::iota(times.begin(), times.end(), 0.0);
  const double range[2] = { times.front(), times.back() };
  info->Set(Pipeline::TIME_STEPS(), times.data(), files);
  info->Set(Pipeline::TIME_RANGE(), range, 2);
  info->Set(Pipeline::TIME_DEPENDENT_INFORMATION(), 1);
}
}

struct vtkVDBReader::Internals
{
  /// The file whose grids are listed (null: none, or it cannot be read), and the path of the last file that was listed.
  std::unique_ptr<VDBFile> File;
  std::string Path;
  std::string Summary;
  std::vector<std::string> Files; ///< paths of the files, in order of time for a series
  int ListedFile = -1;            ///< index in Files of the file whose grids are listed; -1: none
  std::set<std::string> Listed;   ///< names of grids that were added to the selection because a file has them
  std::string OnlyGrid;           ///< name passed to SetGridName, not applied yet; empty: none

  std::vector<const VDBGrid*> Chosen;
  tyndall::VDBGeometry Image;
  bool IsBare = false;    ///< whether no chosen grid has an active voxel
  std::string NoImageYet; ///< why the chosen grids cannot become an image unless Resample is on; empty: they can

  bool Resample = false; ///< whether grids with oblique axes are resampled
  /// Whether the grids are oblique and are resampled to Image, which is aligned with the world axes.
  bool Resampled = false;
  tyndall::VDBGeometry Own; ///< geometry of the grids themselves if they are resampled

  bool IsSeries() const { return this->Files.size() > 1; }
  void Look(int file, vtkDataArraySelection* selection, vtkIdType maximumMemory);
  void List(int file);
  void Offer(vtkDataArraySelection* selection);
  void Choose(vtkDataArraySelection* selection);
  void ChooseGrid(const std::string& name);
  void CheckMemory(vtkIdType maximum) const;

  struct Limit
  {
    double Bytes;
    std::string Why;
  };
  Limit LimitOfMemory(vtkIdType maximum) const;
};

/// Lists the grids of one of the files, and determines the geometry of the image of its chosen grids.
void vtkVDBReader::Internals::Look(int file, vtkDataArraySelection* selection, vtkIdType maximumMemory)
{
  this->Chosen.clear();
  this->NoImageYet.clear();
  this->List(file);
  this->Offer(selection);
  this->Choose(selection);
  this->CheckMemory(maximumMemory);
}

/// Lists the grids of a file. The file is read again at each call: this takes milliseconds, and time stamp and length
/// do not tell whether the file was rewritten.
void vtkVDBReader::Internals::List(int file)
{
  this->File.reset();
  this->Summary.clear();
  this->ListedFile = file;
  tyndall::Require(
    !this->Files.empty() && !this->Files[static_cast<std::size_t>(file)].empty(), "No file: set FileName.");
  const std::string& path = this->Files[static_cast<std::size_t>(file)];
  this->File.reset(new VDBFile(path));
  this->Path = path;
  this->Summary = ::Summary(*this->File);
}

namespace
{
/// The grid that determines the default selection, by its transform: the first grid that needs no Resample, otherwise
/// the first that can be resampled. The choice is thus the same whether Resample is set before or after the file.
/// @return null: no grid can become an image
const VDBGrid* FirstToChoose(const std::vector<VDBGrid>& grids)
{
  const VDBGrid* chosen = nullptr;
  for (const VDBGrid& grid : grids)
  {
    const bool isBetter = chosen == nullptr || (chosen->Shears && !grid.Shears);
    chosen = grid.Unusable.empty() && isBetter ? &grid : chosen;
  }
  return chosen;
}
}

/// Adds the file's grids to the selection. By default the grids that share the transform of FirstToChoose are selected.
/// Grids of other files of a series remain in the selection.
void vtkVDBReader::Internals::Offer(vtkDataArraySelection* selection)
{
  for (auto name = this->Listed.begin(); name != this->Listed.end();)
  {
    if (!this->IsSeries() && this->File->Find(*name) == nullptr)
    {
      selection->RemoveArrayByName(name->c_str());
      name = this->Listed.erase(name);
    }
    else
    {
      ++name;
    }
  }
  const VDBGrid* const first = FirstToChoose(this->File->Grids());
  for (const VDBGrid& grid : this->File->Grids())
  {
    if (!selection->ArrayExists(grid.Name.c_str()))
    {
      selection->AddArray(grid.Name.c_str(), first && grid.Unusable.empty() && tyndall::SharesTransform(*first, grid));
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

/// Adds a grid to the chosen grids. Names of grids that only other files of a series have are skipped.
void vtkVDBReader::Internals::ChooseGrid(const std::string& name)
{
  const VDBGrid* const grid = this->File->Find(name);
  if (grid == nullptr && this->IsSeries() && this->Listed.count(name) > 0)
  {
    return;
  }
  if (grid == nullptr)
  {
    std::string available;
    for (const VDBGrid& other : this->File->Grids())
    {
      available += (available.empty() ? "\"" : ", \"") + other.Name + "\"";
    }
    throw InvalidInput(
      "\"" + this->Path + "\" has no grid \"" + name + "\". It has " + (available.empty() ? "none" : available) + ".");
  }
  const std::string cannot = "Grid \"" + name + "\" of \"" + this->Path + "\" cannot become an image: ";
  tyndall::Require(grid->Unusable.empty(), cannot + grid->Unusable + ", or switch it off.");
  if (grid->Shears && !this->Resample && this->NoImageYet.empty())
  {
    this->NoImageYet =
      cannot + "its transform shears; an image needs axes at right angles. Switch Resample on, or the grid off.";
  }
  if (!this->Chosen.empty() && !tyndall::SharesTransform(*this->Chosen.front(), *grid))
  {
    throw InvalidInput("Grids \"" + this->Chosen.front()->Name + "\" and \"" + name + "\" of \"" + this->Path +
      "\" have different transforms, so one image cannot hold both. Switch one off, and read it with a second "
      "reader.");
  }
  this->Chosen.push_back(grid);
}

void vtkVDBReader::Internals::Choose(vtkDataArraySelection* selection)
{
  this->Chosen.clear();
  this->IsBare = this->Resampled = false;
  this->Image = {};
  const auto& grids = this->File->Grids();
  if (this->IsSeries() && grids.empty())
  {
    this->IsBare = true;
    return;
  }
  if (std::none_of(grids.begin(), grids.end(), [](const VDBGrid& grid) { return grid.Unusable.empty(); }) &&
    selection->GetNumberOfArraysEnabled() == 0)
  {
    throw InvalidInput(grids.empty() ? "\"" + this->Path + "\" holds no grid."
                                     : "No grid of \"" + this->Path + "\" can become an image. Of \"" +
          grids.front().Name + "\", " + grids.front().Unusable + ".");
  }
  for (int i = 0; i < selection->GetNumberOfArrays(); ++i)
  {
    if (selection->GetArraySetting(i))
    {
      this->ChooseGrid(selection->GetArrayName(i));
    }
  }
  if (!this->NoImageYet.empty())
  {
    this->Chosen.clear();
    return;
  }
  // Chosen grids are in the order of the file, not of the selection.
  std::sort(this->Chosen.begin(), this->Chosen.end());
  if (!this->Chosen.empty())
  {
    this->Image = tyndall::GeometryOf(this->Chosen);
    this->Own = this->Image;
    this->Resampled = this->Resample && !this->Image.Empty() &&
      (this->Chosen.front()->Shears || !tyndall::WaysOf(this->Image.Spacing.data(), this->Image.Direction.data()));
    this->Image = this->Resampled ? tyndall::BoxAround(this->Chosen) : this->Image;
  }
  this->IsBare = this->Image.Empty() && (this->IsSeries() || !this->Chosen.empty());
}

void vtkVDBReader::Internals::CheckMemory(vtkIdType maximum) const
{
  const auto& extent = this->Image.Extent;
  for (int axis = 0; axis < 3; ++axis)
  {
    tyndall::Require(extent[2 * axis] >= VTK_INT_MIN && extent[2 * axis + 1] <= VTK_INT_MAX,
      "The active voxels of \"" + this->Path + "\" reach further than VTK counts.");
  }
  double image = 0.0, tree = 0.0;
  for (const VDBGrid* grid : this->Chosen)
  {
    image += BytesAsImage(*grid, extent) + (this->Resampled ? BytesAsImage(*grid, this->Own.Extent) : 0.0);
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

/// Executive for series of files that differ in extent. VTK requests the extent before it specifies the time step. If
/// the time step belongs to another file than the announced one, this executive announces the extent of that file.
/// Filters downstream may still request the earlier extent; a request that the new extent does not cover is replaced by
/// the complete new extent. (VTK's list of consumers cannot be used to inform these filters: it includes consumers that
/// no longer exist.)
class vtkVDBReader::SeriesPipeline : public vtkCompositeDataPipeline
{
public:
  static SeriesPipeline* New();
  vtkTypeMacro(SeriesPipeline, vtkCompositeDataPipeline);

  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override
  {
    auto* const reader = vtkVDBReader::SafeDownCast(this->GetAlgorithm());
    vtkInformation* const output = outputs->GetInformationObject(0);
    if (reader && !this->IsTelling && request->Has(REQUEST_TIME_DEPENDENT_INFORMATION()) &&
      reader->FileAskedFor(output) != reader->Internal->ListedFile)
    {
      this->IsTelling = true;
      const tyndall::UpdateRequest asked(output);
      reader->Modified();
      this->UpdateInformation();
      asked.Restore();
      this->IsTelling = false;
      return 1;
    }
    if (request->Has(REQUEST_UPDATE_EXTENT()) && output->Has(UPDATE_EXTENT()) && output->Has(WHOLE_EXTENT()))
    {
      std::array<int, 6> asked;
      output->Get(UPDATE_EXTENT(), asked.data());
      const bool isEmpty = asked[0] > asked[1] || asked[2] > asked[3] || asked[4] > asked[5];
      if (!isEmpty && (tyndall::AsksForAll(output) || !tyndall::Covers(output->Get(WHOLE_EXTENT()), asked.data())))
      {
        std::array<int, 6> whole;
        output->Get(WHOLE_EXTENT(), whole.data());
        output->Set(UPDATE_EXTENT(), whole.data(), 6);
      }
    }
    return this->Superclass::ProcessRequest(request, inputs, outputs);
  }

private:
  bool IsTelling = false;
};

vtkStandardNewMacro(vtkVDBReader::SeriesPipeline);

vtkStandardNewMacro(vtkVDBReader);

vtkVDBReader::vtkVDBReader()
  : Internal(new Internals)
{
  this->SetNumberOfInputPorts(0);
}

vtkVDBReader::~vtkVDBReader() = default;

vtkExecutive* vtkVDBReader::CreateDefaultExecutive()
{
  return SeriesPipeline::New();
}

void vtkVDBReader::SetExecutive(vtkExecutive* executive)
{
  if (!executive || SeriesPipeline::SafeDownCast(executive))
  {
    this->Superclass::SetExecutive(executive);
  }
}

void vtkVDBReader::SetFileName(const char* fileName)
{
  const std::vector<std::string> files = fileName ? std::vector<std::string>{ fileName } : std::vector<std::string>();
  if (files != this->Internal->Files)
  {
    this->Internal->Files = files;
    this->Modified();
  }
}

void vtkVDBReader::AddFileName(const char* fileName)
{
  this->Internal->Files.emplace_back(fileName ? fileName : "");
  this->Modified();
}

void vtkVDBReader::RemoveAllFileNames()
{
  this->Internal->Files.clear();
  this->Modified();
}

int vtkVDBReader::GetNumberOfFileNames() const
{
  return static_cast<int>(this->Internal->Files.size());
}

const char* vtkVDBReader::GetFileName(int index)
{
  const bool isThere = index >= 0 && index < this->GetNumberOfFileNames();
  return isThere ? this->Internal->Files[static_cast<std::size_t>(index)].c_str() : nullptr;
}

const char* vtkVDBReader::GetCurrentFileName()
{
  return this->Internal->Path.c_str();
}

/// Index of the last file of the series whose time is not later than the requested time; 0 if no time is requested.
int vtkVDBReader::FileAskedFor(vtkInformation* output) const
{
  constexpr double rounding = 1e-6; // tolerance of the requested time, which may be the result of a computation
  const double time = output->Has(Pipeline::UPDATE_TIME_STEP()) ? output->Get(Pipeline::UPDATE_TIME_STEP()) : 0.0;
  return time > 0.0 ? static_cast<int>(std::min(time + rounding, std::max(this->GetNumberOfFileNames() - 1.0, 0.0)))
                    : 0;
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
  info->Set(Pipeline::WHOLE_EXTENT(), NoExtent, 6);
  info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  TellTimes(info, this->GetNumberOfFileNames());
  internal.Resample = this->Resample;
  const bool listed = tyndall::GuardedInformation(
    this, [&] { internal.Look(this->FileAskedFor(info), this->GridSelection, this->MaximumMemory); });
  if (!listed)
  {
    internal.Chosen.clear();
    internal.IsBare = false;
    return 1;
  }
  if (internal.IsBare && !internal.IsSeries())
  {
    vtkWarningMacro("The chosen grids of \"" << internal.Path << "\" have no active voxels, so the image is empty.");
  }

  const tyndall::VDBGeometry& image = internal.Image;
  info->Set(Pipeline::WHOLE_EXTENT(), WholeExtentOf(image).data(), 6);
  info->Set(vtkDataObject::ORIGIN(), image.Origin.data(), 3);
  info->Set(vtkDataObject::SPACING(), image.Spacing.data(), 3);
  info->Set(vtkDataObject::DIRECTION(), image.Direction.data(), 9);
  return 1;
}

/// The extent to read for a request. If filters downstream know only the extent of another file of the series, a
/// request for all of that extent becomes one for the complete extent of this file, and a request for a part is clipped
/// to this file's extent.
std::array<int, 6> vtkVDBReader::ExtentToRead(vtkInformation* info)
{
  tyndall::NoteExtentTold(info);
  std::array<int, 6> asked, told;
  info->Get(Pipeline::UPDATE_EXTENT(), asked.data());
  info->Get(Pipeline::WHOLE_EXTENT(), told.data());
  const int file = this->FileAskedFor(info);
  if (file == this->Internal->ListedFile)
  {
    return asked;
  }
  this->Internal->Look(file, this->GridSelection, this->MaximumMemory);
  const std::array<int, 6> whole = WholeExtentOf(this->Internal->Image);
  std::array<int, 6> extent = whole;
  for (int i = 0; i < 6 && asked != told; ++i)
  {
    extent[i] = i % 2 == 0 ? std::max(asked[i], whole[i]) : std::min(asked[i], whole[i]);
  }
  info->Set(Pipeline::WHOLE_EXTENT(), whole.data(), 6);
  info->Set(Pipeline::UPDATE_EXTENT(), extent.data(), 6);
  return extent;
}

/// Reads the chosen grids, and adds them to an image as cell arrays of the cells in `extent`.
void vtkVDBReader::ReadGrids(const std::array<int, 6>& extent, vtkImageData* image)
{
  Internals& internal = *this->Internal;
  const tyndall::VDBGeometry& geometry = internal.Image;
  image->SetExtent(std::array<int, 6>(extent).data());
  image->SetOrigin(geometry.Origin.data());
  image->SetSpacing(geometry.Spacing.data());
  image->SetDirectionMatrix(geometry.Direction.data());

  const std::array<int, 6> own = internal.Resampled ? WholeExtentOf(internal.Own) : extent;
  const openvdb::CoordBBox box = CellsIn(own.data());
  double done = 0.0;
  for (const VDBGrid* grid : internal.Chosen)
  {
    if (this->GetAbortExecute())
    {
      throw tyndall::Aborted();
    }
    vtkNew<vtkImageData> cells;
    vtkImageData* const asRead = internal.Resampled ? cells.Get() : image;
    if (internal.Resampled)
    {
      cells->SetExtent(std::array<int, 6>(own).data());
    }
    tyndall::AddGridCells(*internal.File->Read(*grid, box), grid->Type, grid->Name, box, asRead);
    if (internal.Resampled)
    {
      tyndall::AddResampled(cells, *grid, box, image);
    }
    tyndall::AddMetadata(image, tyndall::FieldName(grid->Name, ""), grid->Metadata);
    if (this->LevelSetsAsFog)
    {
      tyndall::MakeFogOfLevelSet(image, grid->Name);
    }
    this->UpdateProgress(++done / static_cast<double>(internal.Chosen.size()));
  }
  tyndall::AddMetadata(image, tyndall::FieldName("", ""), internal.File->Metadata());
  tyndall::AddFact(image, tyndall::ActivePartFact, std::vector<double>{ ActivePart(internal.Chosen, geometry.Extent) });
  tyndall::AddMediumFacts(image, internal.File->Metadata());
  image->GetCellData()->SetActiveScalars(internal.Chosen.front()->Name.c_str());
}

int vtkVDBReader::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  return tyndall::Guarded(this, outputs, [&] {
    vtkInformation* info = outputs->GetInformationObject(0);
    vtkImageData* image = vtkImageData::GetData(info);
    image->Initialize();
    Internals& internal = *this->Internal;
    std::array<int, 6> extent = this->ExtentToRead(info);
    if (!internal.NoImageYet.empty())
    {
      // Thrown only when data are read, not when the grids are listed: the user may set Resample in between.
      throw InvalidInput(internal.NoImageYet);
    }
    if (internal.IsSeries())
    {
      image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), internal.ListedFile);
    }
    else
    {
      image->GetInformation()->Remove(vtkDataObject::DATA_TIME_STEP());
    }
    if (internal.IsBare)
    {
      tyndall::AddFact(image, tyndall::EmptyFact, std::vector<double>{ 1.0 });
    }
    if (internal.Chosen.empty() || extent[0] > extent[1] || extent[2] > extent[3] || extent[4] > extent[5])
    {
      return;
    }
    this->ReadGrids(extent, image);
  });
}

void vtkVDBReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->GetFileName() ? this->GetFileName() : "(none)") << "\n";
  os << indent << "Files: " << this->GetNumberOfFileNames() << "\n";
  tyndallPrintMacro(Resample, LevelSetsAsFog, MaximumMemory);
  os << indent << "GridSelection:\n";
  this->GridSelection->PrintSelf(os, indent.GetNextIndent());
}
