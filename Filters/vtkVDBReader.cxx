#include "vtkVDBReader.h"

#include "LightTransportData.h"
#include "VDBFile.h"
#include "VDBNames.h"

#include "vtkCellData.h"
#include "vtkDataArraySelection.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <set>
#include <sstream>
#include <unistd.h>

using tyndall::InvalidInput;
using tyndall::VDBFile;
using tyndall::VDBGrid;
using tyndall::VoxelBox;

namespace
{
/// Where the chosen grids lie, as an image: extent of points, and voxels for its cells.
struct Geometry
{
  std::array<std::int64_t, 6> Extent = { 0, -1, 0, -1, 0, -1 };
  std::array<double, 3> Origin = { 0, 0, 0 };
  std::array<double, 3> Spacing = { 1, 1, 1 };
  std::array<double, 9> Direction = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
};

std::string ToString(const VoxelBox& box)
{
  std::ostringstream text;
  text << "[" << box.Min[0] << ", " << box.Min[1] << ", " << box.Min[2] << "] to [" << box.Max[0] << ", " << box.Max[1]
       << ", " << box.Max[2] << "]";
  return text.str();
}

std::string Bytes(double bytes)
{
  std::ostringstream text;
  text.precision(3);
  const char* units[] = { "B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB" };
  int unit = 0;
  for (; bytes >= 1024.0 && unit < 6; ++unit)
  {
    bytes /= 1024.0;
  }
  text << (bytes >= 1000.0 ? std::round(bytes) : bytes) << " " << units[unit];
  return text.str();
}

double BytesAVoxel(const VDBGrid& grid)
{
  const std::string& type = grid.Type;
  const double number = type == "bool" || type == "mask" ? 1.0
    : type == "double" || type == "int64" || type == "vec3d" ? 8.0 : 4.0;
  return number * (type.compare(0, 4, "vec3") == 0 ? 3.0 : 1.0);
}

/// Cells along an axis of an image: a flat image has one.
std::int64_t LastVoxel(std::int64_t first, std::int64_t last)
{
  return std::max(first, last - 1);
}

double CellsOf(const std::array<std::int64_t, 6>& extent)
{
  double cells = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    cells *= static_cast<double>(
      LastVoxel(extent[2 * axis], extent[2 * axis + 1]) - extent[2 * axis] + 1);
  }
  return extent[0] > extent[1] ? 0.0 : cells;
}

/// Whether a grid's voxels lie where another's do, to rounding.
bool SharesTransform(const VDBGrid& a, const VDBGrid& b)
{
  for (int i = 0; i < 3; ++i)
  {
    const double size = std::sqrt(a.Axes[i][0] * a.Axes[i][0] + a.Axes[i][1] * a.Axes[i][1] + a.Axes[i][2] * a.Axes[i][2]);
    for (int j = 0; j < 3; ++j)
    {
      if (!(std::abs(a.Axes[i][j] - b.Axes[i][j]) <= 1e-9 * size))
      {
        return false;
      }
    }
    const double near = 1e-6 * size + 1e-12 * std::abs(a.Translation[i]);
    if (!(std::abs(a.Translation[i] - b.Translation[i]) <= near))
    {
      return false;
    }
  }
  return true;
}

template <typename T>
const T* MetadataValue(const openvdb::MetaMap& map, const char* key)
{
  const auto metadata = map.getMetadata<openvdb::TypedMetadata<T>>(key);
  return metadata ? &metadata->value() : nullptr;
}

/// The extent of points that a grid covers: as the writer noted it, as long as that still holds every active voxel.
std::array<std::int64_t, 6> ExtentOf(const VDBGrid& grid)
{
  std::array<std::int64_t, 6> extent = { 0, -1, 0, -1, 0, -1 };
  const VoxelBox& active = grid.ActiveBox;
  const auto* min = MetadataValue<openvdb::Vec3i>(grid.Metadata, tyndall::ImageMinKey);
  const auto* max = MetadataValue<openvdb::Vec3i>(grid.Metadata, tyndall::ImageMaxKey);
  bool noted = min && max;
  for (int axis = 0; axis < 3 && noted; ++axis)
  {
    extent[2 * axis] = (*min)[axis];
    extent[2 * axis + 1] = (*max)[axis];
    noted = (*min)[axis] <= (*max)[axis] &&
      (active.Empty() ||
        ((*min)[axis] <= active.Min[axis] && active.Max[axis] <= LastVoxel((*min)[axis], (*max)[axis])));
  }
  for (int axis = 0; axis < 3 && !noted; ++axis)
  {
    extent[2 * axis] = active.Empty() ? 0 : active.Min[axis];
    extent[2 * axis + 1] = active.Empty() ? -1 : active.Max[axis] + 1;
  }
  return extent;
}

Geometry GeometryOf(const std::vector<const VDBGrid*>& grids)
{
  Geometry geometry;
  for (const VDBGrid* grid : grids)
  {
    const auto extent = ExtentOf(*grid);
    if (extent[0] > extent[1])
    {
      continue;
    }
    const bool first = geometry.Extent[0] > geometry.Extent[1];
    for (int axis = 0; axis < 3; ++axis)
    {
      std::int64_t& low = geometry.Extent[2 * axis];
      std::int64_t& high = geometry.Extent[2 * axis + 1];
      low = first ? extent[2 * axis] : std::min(low, extent[2 * axis]);
      high = first ? extent[2 * axis + 1] : std::max(high, extent[2 * axis + 1]);
    }
  }

  const VDBGrid& grid = *grids.front();
  bool aligned = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto& step = grid.Axes[axis];
    const bool along = step[(axis + 1) % 3] == 0.0 && step[(axis + 2) % 3] == 0.0;
    aligned = aligned && along;
    geometry.Spacing[axis] =
      along ? std::abs(step[axis]) : std::sqrt(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]);
    for (int row = 0; row < 3; ++row)
    {
      geometry.Direction[3 * row + axis] = step[row] / geometry.Spacing[axis];
    }
  }
  // Half a voxel below the centre of voxel 0.
  for (int row = 0; row < 3; ++row)
  {
    geometry.Origin[row] = tyndall::CentreOfFirstVoxel(grid.Translation[row], grid.Axes, row, -0.5);
  }

  // To the last bit as the writer noted them, as long as the transform is still the same.
  const auto* origin = MetadataValue<openvdb::Vec3d>(grid.Metadata, tyndall::ImageOriginKey);
  const auto* spacing = MetadataValue<openvdb::Vec3d>(grid.Metadata, tyndall::ImageSpacingKey);
  if (origin && spacing)
  {
    auto steps = grid.Axes;
    bool same = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double rounding = 4e-16 * (std::abs(grid.Translation[axis]) + 4.0 * geometry.Spacing[axis]);
      same = same && std::abs((*spacing)[axis] - geometry.Spacing[axis]) <= rounding;
      steps[axis][axis] = aligned ? geometry.Direction[4 * axis] * (*spacing)[axis] : steps[axis][axis];
    }
    for (int row = 0; row < 3; ++row)
    {
      same = same && tyndall::CentreOfFirstVoxel((*origin)[row], steps, row) == grid.Translation[row];
    }
    if (same)
    {
      geometry.Origin = { (*origin)[0], (*origin)[1], (*origin)[2] };
      geometry.Spacing = { (*spacing)[0], (*spacing)[1], (*spacing)[2] };
    }
  }
  return geometry;
}

template <typename ArrayT, int Components, typename T>
void AddNumbers(vtkFieldData* field, const std::string& name, const T* values)
{
  vtkNew<ArrayT> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(Components);
  array->SetNumberOfTuples(1);
  for (int i = 0; i < Components; ++i)
  {
    array->SetValue(i, static_cast<typename ArrayT::ValueType>(values[i]));
  }
  field->AddArray(array);
}

void AddText(vtkFieldData* field, const std::string& name, const std::string& text)
{
  vtkNew<vtkStringArray> array;
  array->SetName(name.c_str());
  array->InsertNextValue(text);
  field->AddArray(array);
}

/// One number of metadata becomes one tuple; false if the metadata is of another type.
template <typename ArrayT, typename T, int Components>
bool AddIfOfType(vtkFieldData* field, const std::string& name, const openvdb::Metadata& metadata)
{
  const auto* typed = dynamic_cast<const openvdb::TypedMetadata<T>*>(&metadata);
  if (typed == nullptr)
  {
    return false;
  }
  if constexpr (Components == 1)
  {
    AddNumbers<ArrayT, 1>(field, name, &typed->value());
  }
  else
  {
    AddNumbers<ArrayT, Components>(field, name, typed->value().asPointer());
  }
  return true;
}

void AddMetadata(vtkFieldData* field, const std::string& prefix, const openvdb::MetaMap& map)
{
  for (auto entry = map.beginMeta(); entry != map.endMeta(); ++entry)
  {
    const std::string& key = entry->first;
    const openvdb::Metadata& value = *entry->second;
    if (key == tyndall::ImageMinKey || key == tyndall::ImageMaxKey || key == tyndall::ImageOriginKey ||
      key == tyndall::ImageSpacingKey)
    {
      continue; // the image says them itself
    }
    const std::string name = prefix + key;
    if (const auto* text = dynamic_cast<const openvdb::StringMetadata*>(&value))
    {
      AddText(field, name, text->value());
      continue;
    }
    AddIfOfType<vtkUnsignedCharArray, bool, 1>(field, name, value) ||
      AddIfOfType<vtkIntArray, openvdb::Int32, 1>(field, name, value) ||
      AddIfOfType<vtkTypeInt64Array, openvdb::Int64, 1>(field, name, value) ||
      AddIfOfType<vtkFloatArray, float, 1>(field, name, value) ||
      AddIfOfType<vtkDoubleArray, double, 1>(field, name, value) ||
      AddIfOfType<vtkIntArray, openvdb::Vec2i, 2>(field, name, value) ||
      AddIfOfType<vtkFloatArray, openvdb::Vec2s, 2>(field, name, value) ||
      AddIfOfType<vtkDoubleArray, openvdb::Vec2d, 2>(field, name, value) ||
      AddIfOfType<vtkIntArray, openvdb::Vec3i, 3>(field, name, value) ||
      AddIfOfType<vtkFloatArray, openvdb::Vec3s, 3>(field, name, value) ||
      AddIfOfType<vtkDoubleArray, openvdb::Vec3d, 3>(field, name, value) ||
      AddIfOfType<vtkIntArray, openvdb::Vec4i, 4>(field, name, value) ||
      AddIfOfType<vtkFloatArray, openvdb::Vec4s, 4>(field, name, value) ||
      AddIfOfType<vtkDoubleArray, openvdb::Vec4d, 4>(field, name, value) ||
      AddIfOfType<vtkFloatArray, openvdb::Mat4s, 16>(field, name, value) ||
      AddIfOfType<vtkDoubleArray, openvdb::Mat4d, 16>(field, name, value);
  }
}

/// Cells and background of a grid's tree.
/// @tparam T  the number, or a vector's
template <typename GridT, typename ArrayT, int Components>
void AddCells(const openvdb::GridBase& grid, const openvdb::CoordBBox& box, const std::string& name, vtkImageData* image)
{
  using T = typename ArrayT::ValueType;
  using Value = std::conditional_t<Components == 1, T, openvdb::math::Vec3<T>>;
  const auto& tree = static_cast<const GridT&>(grid).tree();
  vtkNew<ArrayT> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(Components);
  array->SetNumberOfTuples(image->GetNumberOfCells());
  openvdb::tools::Dense<Value, openvdb::tools::LayoutXYZ> dense(box, reinterpret_cast<Value*>(array->GetPointer(0)));
  openvdb::tools::copyToDense(tree, dense);
  image->GetCellData()->AddArray(array);

  const Value background(tree.background());
  AddNumbers<ArrayT, Components>(
    image->GetFieldData(), tyndall::FieldName(name, "background"), reinterpret_cast<const T*>(&background));
}

void AddGrid(const VDBGrid& grid, VDBFile& file, const openvdb::CoordBBox& box, vtkImageData* image)
{
  const openvdb::GridBase::Ptr tree = file.Read(grid, box);
  if (grid.Type == "float")
  {
    AddCells<openvdb::FloatGrid, vtkFloatArray, 1>(*tree, box, grid.Name, image);
  }
  else if (grid.Type == "double")
  {
    AddCells<openvdb::DoubleGrid, vtkDoubleArray, 1>(*tree, box, grid.Name, image);
  }
  else if (grid.Type == "int32")
  {
    AddCells<openvdb::Int32Grid, vtkIntArray, 1>(*tree, box, grid.Name, image);
  }
  else if (grid.Type == "int64")
  {
    AddCells<openvdb::Int64Grid, vtkTypeInt64Array, 1>(*tree, box, grid.Name, image);
  }
  else if (grid.Type == "bool")
  {
    AddCells<openvdb::BoolGrid, vtkUnsignedCharArray, 1>(*tree, box, grid.Name, image);
  }
  else if (grid.Type == "mask")
  {
    AddCells<openvdb::MaskGrid, vtkUnsignedCharArray, 1>(*tree, box, grid.Name, image);
  }
  else if (grid.Type == "vec3i")
  {
    AddCells<openvdb::Vec3IGrid, vtkIntArray, 3>(*tree, box, grid.Name, image);
  }
  else if (grid.Type == "vec3s")
  {
    AddCells<openvdb::Vec3SGrid, vtkFloatArray, 3>(*tree, box, grid.Name, image);
  }
  else
  {
    AddCells<openvdb::Vec3DGrid, vtkDoubleArray, 3>(*tree, box, grid.Name, image);
  }
  AddMetadata(image->GetFieldData(), tyndall::FieldName(grid.Name, ""), grid.Metadata);
  AddText(image->GetFieldData(), tyndall::FieldName(grid.Name, "type"), grid.Type);
}

std::string Summary(const VDBFile& file)
{
  std::ostringstream lines;
  for (const VDBGrid& grid : file.Grids())
  {
    lines << grid.Name << ": " << grid.Type << (grid.Half ? " (16 bits in the file)" : "") << ", ";
    if (!grid.Unusable.empty())
    {
      lines << "not readable as an image: " << grid.Unusable << "\n";
      continue;
    }
    if (grid.ActiveBox.Empty())
    {
      lines << "no active voxels\n";
      continue;
    }
    lines << grid.ActiveVoxels << " active voxels in " << ToString(grid.ActiveBox) << ", "
          << Bytes(static_cast<double>(grid.TreeBytes)) << " as a tree, "
          << Bytes(CellsOf(ExtentOf(grid)) * BytesAVoxel(grid)) << " as an image\n";
  }
  return lines.str();
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
  Geometry Image;
  bool IsBare = false; ///< no chosen grid has an active voxel

  void List(const char* path);
  void Offer(vtkDataArraySelection* selection);
  void Choose(vtkDataArraySelection* selection);
  void CheckMemory(vtkIdType maximum) const;
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
      selection->AddArray(grid.Name.c_str(), usable && SharesTransform(*first, grid));
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
  this->Image = Geometry();
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
    if (!this->Chosen.empty() && !SharesTransform(*this->Chosen.front(), *grid))
    {
      throw InvalidInput("Grids \"" + this->Chosen.front()->Name + "\" and \"" + name + "\" of \"" + this->Path +
        "\" have different transforms, so one image cannot hold both. Switch one off, and read it with a second reader.");
    }
    this->Chosen.push_back(grid);
  }
  // In the order of the file, whatever the order in which they were chosen.
  std::sort(this->Chosen.begin(), this->Chosen.end());
  if (!this->Chosen.empty())
  {
    this->Image = GeometryOf(this->Chosen);
    this->IsBare = this->Image.Extent[0] > this->Image.Extent[1];
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
    image += CellsOf(extent) * BytesAVoxel(*grid);
    tree = std::max(tree, static_cast<double>(grid->TreeBytes));
  }
  const double limit = maximum > 0
    ? static_cast<double>(maximum) * 1048576.0
    : 0.5 * static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (image + tree > limit)
  {
    const VoxelBox box{ { extent[0], extent[2], extent[4] },
      { LastVoxel(extent[0], extent[1]), LastVoxel(extent[2], extent[3]), LastVoxel(extent[4], extent[5]) } };
    std::ostringstream text;
    text << "The chosen grids of \"" << this->Path << "\" need " << Bytes(image + tree) << " (" << std::fixed
         << std::setprecision(0) << image + tree << " bytes) as an image of voxels " << ToString(box)
         << "; the limit is " << Bytes(limit) << ". Choose fewer grids, resample or crop the file, or raise MaximumMemory ("
         << (maximum > 0 ? "" : "untouched it is half of this machine's memory; ") << "in MiB).";
    throw InvalidInput(text.str());
  }
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
  try
  {
    internal.List(this->FileName);
    internal.Offer(this->GridSelection);
    internal.Choose(this->GridSelection);
    internal.CheckMemory(this->MaximumMemory);
  }
  catch (const std::exception& error)
  {
    internal.Chosen.clear();
    vtkErrorMacro(<< error.what());
    return 1; // The output is empty; a failure would make the pipeline add an error that says less.
  }
  if (internal.IsBare)
  {
    vtkWarningMacro("The chosen grids of \"" << internal.Path << "\" have no active voxels, so the image is empty.");
  }

  const Geometry& image = internal.Image;
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
    const Geometry& geometry = internal.Image;
    image->SetExtent(extent);
    image->SetOrigin(geometry.Origin.data());
    image->SetSpacing(geometry.Spacing.data());
    image->SetDirectionMatrix(geometry.Direction.data());

    openvdb::CoordBBox box;
    for (int axis = 0; axis < 3; ++axis)
    {
      box.min()[axis] = extent[2 * axis];
      box.max()[axis] = static_cast<int>(LastVoxel(extent[2 * axis], extent[2 * axis + 1]));
    }
    double done = 0.0;
    for (const VDBGrid* grid : internal.Chosen)
    {
      if (this->GetAbortExecute())
      {
        throw tyndall::Aborted();
      }
      AddGrid(*grid, *internal.File, box, image);
      this->UpdateProgress(++done / static_cast<double>(internal.Chosen.size()));
    }
    AddMetadata(image->GetFieldData(), tyndall::FieldName("", ""), internal.File->Metadata());
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
