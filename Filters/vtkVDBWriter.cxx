#include "vtkVDBWriter.h"

#include "Device/Errors.h"
#include "VDBFile.h"
#include "VDBNames.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointDataToCellData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <type_traits>
#include <unistd.h>

using tyndall::InvalidInput;

namespace
{
struct Options
{
  double Background;
  double Tolerance;
  bool Half;
};

/// Voxels and place of an image.
struct Placement
{
  openvdb::CoordBBox Voxels;
  openvdb::math::Transform::Ptr Transform;
  openvdb::Vec3i ExtentMin, ExtentMax;
  openvdb::Vec3d Origin, Spacing;
};

Placement PlacementOf(vtkImageData* image)
{
  Placement place;
  const int* extent = image->GetExtent();
  const double* origin = image->GetOrigin();
  const double* spacing = image->GetSpacing();
  vtkMatrix3x3* direction = image->GetDirectionMatrix();
  std::array<std::array<double, 3>, 3> steps;
  openvdb::Mat4d matrix = openvdb::Mat4d::identity(); // multiplies row vectors from the right
  bool aligned = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    place.Voxels.min()[axis] = extent[2 * axis];
    place.Voxels.max()[axis] = std::max(extent[2 * axis], extent[2 * axis + 1] - 1); // a flat image has one layer
    place.ExtentMin[axis] = extent[2 * axis];
    place.ExtentMax[axis] = extent[2 * axis + 1];
    place.Origin[axis] = origin[axis];
    place.Spacing[axis] = spacing[axis];
    for (int row = 0; row < 3; ++row)
    {
      steps[axis][row] = direction->GetElement(row, axis) * spacing[axis];
      matrix(axis, row) = steps[axis][row];
      aligned = aligned && (row == axis ? steps[axis][row] > 0.0 : steps[axis][row] == 0.0);
    }
  }
  openvdb::Vec3d centre;
  for (int row = 0; row < 3; ++row)
  {
    centre[row] = tyndall::CentreOfFirstVoxel(origin[row], steps, row);
    matrix(3, row) = centre[row];
    if (!std::isfinite(centre[row]) || !(spacing[row] > 0.0) || !std::isfinite(spacing[row]))
    {
      throw InvalidInput("The image's spacing must be positive, and its spacing and origin finite.");
    }
  }
  openvdb::math::MapBase::Ptr map;
  if (aligned)
  {
    map.reset(new openvdb::math::ScaleTranslateMap(openvdb::Vec3d(spacing[0], spacing[1], spacing[2]), centre));
  }
  else
  {
    map.reset(new openvdb::math::AffineMap(matrix));
  }
  place.Transform.reset(new openvdb::math::Transform(map));
  return place;
}

template <typename T>
bool SameBits(const T& a, const T& b)
{
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

template <typename T>
bool Near(const T& a, const T& b, double tolerance)
{
  if constexpr (openvdb::VecTraits<T>::IsVec)
  {
    return Near(a[0], b[0], tolerance) && Near(a[1], b[1], tolerance) && Near(a[2], b[2], tolerance);
  }
  else
  {
    return std::abs(static_cast<double>(a) - static_cast<double>(b)) <= tolerance; // never for NaN
  }
}

/// An array's numbers, tuple by tuple.
template <typename T>
struct Numbers
{
  const T* Values;
  int Components;
};

/// One voxel: numbers from component `first` on.
template <typename Value, typename T>
Value VoxelOf(const Numbers<T>& numbers, vtkIdType cell, int first)
{
  const T* tuple = numbers.Values + cell * numbers.Components + first;
  if constexpr (openvdb::VecTraits<Value>::IsVec)
  {
    using Number = typename Value::ValueType;
    return Value(static_cast<Number>(tuple[0]), static_cast<Number>(tuple[1]), static_cast<Number>(tuple[2]));
  }
  else if constexpr (std::is_same<Value, bool>::value)
  {
    return tuple[0] != 0;
  }
  else
  {
    if constexpr (std::is_unsigned<T>::value && sizeof(T) == sizeof(openvdb::Int64))
    {
      if (tuple[0] > static_cast<T>(INT64_MAX))
      {
        throw InvalidInput("its value " + std::to_string(tuple[0]) + " in cell " + std::to_string(cell) +
          " is above 2^63 - 1, the largest integer of a .vdb file. Convert the array to double");
      }
    }
    return static_cast<Value>(tuple[0]);
  }
}

/// Fills a tree block by block of 8^3 voxels, so that only blocks that are not background are made.
template <typename TreeT, typename T>
void FillTree(TreeT& tree, const Numbers<T>& numbers, int first, const openvdb::CoordBBox& voxels, double tolerance)
{
  using Value = typename TreeT::ValueType;
  constexpr std::int64_t size = TreeT::LeafNodeType::DIM;
  const Value background = tree.background();
  const auto same = [&](const Value& a, const Value& b) {
    return SameBits(a, b) || (tolerance > 0.0 && Near(a, b, tolerance));
  };
  const openvdb::Coord &low = voxels.min(), &high = voxels.max(), cells = voxels.dim();
  const auto blockStart = [&](int axis) { return static_cast<std::int64_t>(low[axis] & ~(int(size) - 1)); };

  for (std::int64_t x = blockStart(0); x <= high[0]; x += size)
  {
    for (std::int64_t y = blockStart(1); y <= high[1]; y += size)
    {
      for (std::int64_t z = blockStart(2); z <= high[2]; z += size)
      {
        const openvdb::Coord corner(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
        openvdb::CoordBBox block = openvdb::CoordBBox::createCube(corner, size);
        bool constant = voxels.isInside(block);
        block.intersect(voxels);
        typename TreeT::LeafNodeType* leaf = nullptr;
        Value one = background;
        for (const openvdb::Coord& voxel : block)
        {
          const openvdb::Coord at = voxel - low;
          const vtkIdType cell = at[0] + static_cast<vtkIdType>(cells[0]) * (at[1] + static_cast<vtkIdType>(cells[1]) * at[2]);
          const Value value = VoxelOf<Value>(numbers, cell, first);
          if (same(value, background))
          {
            constant = false;
            continue;
          }
          if (leaf == nullptr)
          {
            leaf = tree.touchLeaf(corner);
            one = value;
          }
          constant = constant && same(value, one);
          leaf->setValueOn(voxel, value);
        }
        if (leaf != nullptr && constant)
        {
          tree.addTile(1, corner, one, true);
        }
      }
    }
  }
}

/// The array of field data that holds one thing about a grid, if it is there and of that type.
template <typename ArrayT>
ArrayT* FieldOf(vtkFieldData* field, const std::string& array, const char* key)
{
  return ArrayT::SafeDownCast(field->GetAbstractArray(tyndall::FieldName(array, key).c_str()));
}

template <typename GridT, typename T>
openvdb::GridBase::Ptr MakeGrid(const Numbers<T>& numbers, int first, const std::string& array, vtkFieldData* field,
  const Placement& place, const Options& options)
{
  using Value = typename GridT::ValueType;
  Value background = openvdb::zeroVal<Value>();
  double given[3] = { options.Background, options.Background, options.Background };
  vtkDataArray* noted = FieldOf<vtkDataArray>(field, array, "background");
  if (noted && noted->GetNumberOfValues() == (openvdb::VecTraits<Value>::IsVec ? 3 : 1))
  {
    for (vtkIdType i = 0; i < noted->GetNumberOfValues(); ++i)
    {
      given[i] = noted->GetComponent(0, static_cast<int>(i));
    }
  }
  if constexpr (openvdb::VecTraits<Value>::IsVec)
  {
    background = Value(given[0], given[1], given[2]);
  }
  else
  {
    background = static_cast<Value>(given[0]);
  }
  const auto grid = GridT::create(background);
  FillTree(grid->tree(), numbers, first, place.Voxels, options.Tolerance);
  if (std::is_floating_point<Value>::value && given[0] == 0.0)
  {
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  }
  grid->setSaveFloatAsHalf(options.Half);
  return grid;
}

/// One grid of an array: from its component `first`, one or three of them.
template <typename T>
openvdb::GridBase::Ptr MakeGridOfType(const Numbers<T>& numbers, int first, bool vector, const std::string& array,
  vtkFieldData* field, const Placement& place, const Options& options)
{
  const auto make = [&](auto* type) {
    using GridT = std::remove_pointer_t<decltype(type)>;
    return MakeGrid<GridT>(numbers, first, array, field, place, options);
  };
  if constexpr (std::is_same<T, float>::value)
  {
    return vector ? make(static_cast<openvdb::Vec3SGrid*>(nullptr)) : make(static_cast<openvdb::FloatGrid*>(nullptr));
  }
  else if constexpr (std::is_same<T, double>::value)
  {
    return vector ? make(static_cast<openvdb::Vec3DGrid*>(nullptr)) : make(static_cast<openvdb::DoubleGrid*>(nullptr));
  }
  else if constexpr (sizeof(T) > 4 || (std::is_unsigned<T>::value && sizeof(T) == 4))
  {
    return make(static_cast<openvdb::Int64Grid*>(nullptr));
  }
  else
  {
    if constexpr (std::is_same<T, unsigned char>::value)
    {
      vtkStringArray* type = FieldOf<vtkStringArray>(field, array, "type");
      const std::string name = type && type->GetNumberOfValues() == 1 ? type->GetValue(0) : std::string();
      if (!vector && (name == "bool" || name == "mask"))
      {
        return name == "bool" ? make(static_cast<openvdb::BoolGrid*>(nullptr))
                              : make(static_cast<openvdb::MaskGrid*>(nullptr));
      }
    }
    return vector ? make(static_cast<openvdb::Vec3IGrid*>(nullptr)) : make(static_cast<openvdb::Int32Grid*>(nullptr));
  }
}

template <typename T, typename V, int Components, typename ArrayT>
bool InsertIfOfType(openvdb::MetaMap& map, const std::string& key, vtkDataArray* array)
{
  if (!ArrayT::SafeDownCast(array) || array->GetNumberOfValues() != Components)
  {
    return false;
  }
  const T* values = static_cast<const T*>(array->GetVoidPointer(0));
  if constexpr (Components == 1)
  {
    map.insertMeta(key, openvdb::TypedMetadata<V>(static_cast<V>(values[0])));
  }
  else
  {
    map.insertMeta(key, openvdb::TypedMetadata<V>(V(values)));
  }
  return true;
}

/// Metadata from field data whose names begin so.
void RestoreMetadata(openvdb::MetaMap& map, vtkFieldData* field, const std::string& prefix)
{
  for (int i = 0; i < field->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* abstract = field->GetAbstractArray(i);
    const std::string name = abstract->GetName() ? abstract->GetName() : "";
    if (name.size() <= prefix.size() || name.compare(0, prefix.size(), prefix) != 0)
    {
      continue;
    }
    const std::string key = name.substr(prefix.size());
    if (key == "background" || key == "type")
    {
      continue;
    }
    map.removeMeta(key);
    if (auto* text = vtkStringArray::SafeDownCast(abstract))
    {
      if (text->GetNumberOfValues() == 1)
      {
        map.insertMeta(key, openvdb::StringMetadata(text->GetValue(0)));
      }
      continue;
    }
    using namespace openvdb;
    vtkDataArray* array = vtkDataArray::SafeDownCast(abstract);
    if (array == nullptr)
    {
      continue;
    }
    if (array->GetDataTypeSize() == 8 && array->GetDataType() != VTK_DOUBLE && array->GetNumberOfValues() == 1)
    {
      map.insertMeta(key, Int64Metadata(*static_cast<const Int64*>(array->GetVoidPointer(0))));
      continue;
    }
    InsertIfOfType<unsigned char, bool, 1, vtkUnsignedCharArray>(map, key, array) ||
      InsertIfOfType<int, Int32, 1, vtkIntArray>(map, key, array) ||
      InsertIfOfType<float, float, 1, vtkFloatArray>(map, key, array) ||
      InsertIfOfType<double, double, 1, vtkDoubleArray>(map, key, array) ||
      InsertIfOfType<int, Vec2i, 2, vtkIntArray>(map, key, array) ||
      InsertIfOfType<float, Vec2s, 2, vtkFloatArray>(map, key, array) ||
      InsertIfOfType<double, Vec2d, 2, vtkDoubleArray>(map, key, array) ||
      InsertIfOfType<int, Vec3i, 3, vtkIntArray>(map, key, array) ||
      InsertIfOfType<float, Vec3s, 3, vtkFloatArray>(map, key, array) ||
      InsertIfOfType<double, Vec3d, 3, vtkDoubleArray>(map, key, array) ||
      InsertIfOfType<int, Vec4i, 4, vtkIntArray>(map, key, array) ||
      InsertIfOfType<float, Vec4s, 4, vtkFloatArray>(map, key, array) ||
      InsertIfOfType<double, Vec4d, 4, vtkDoubleArray>(map, key, array) ||
      InsertIfOfType<float, Mat4s, 16, vtkFloatArray>(map, key, array) ||
      InsertIfOfType<double, Mat4d, 16, vtkDoubleArray>(map, key, array);
  }
}

/// The grids of one array: one, or one a component.
void AddGrids(openvdb::GridPtrVec& grids, vtkDataArray* array, vtkFieldData* field, const Placement& place,
  const Options& options)
{
  const std::string name = array->GetName() ? array->GetName() : "";
  const int components = array->GetNumberOfComponents();
  const bool wide = array->GetDataTypeSize() > 4 || array->GetDataType() == VTK_UNSIGNED_INT;
  const bool real = array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
  const bool vector = components == 3 && (real || !wide);
  for (int first = 0; first < components; first += vector ? 3 : 1)
  {
    openvdb::GridBase::Ptr grid;
    try
    {
      switch (array->GetDataType())
      {
        vtkTemplateMacro(
          grid = MakeGridOfType(Numbers<VTK_TT>{ static_cast<const VTK_TT*>(array->GetVoidPointer(0)), components },
            first, vector, name, field, place, options));
        default: throw InvalidInput("its type " + std::string(array->GetDataTypeAsString()) + " has no grid. Convert it");
      }
    }
    catch (const InvalidInput& error)
    {
      throw InvalidInput("Array \"" + name + "\" cannot be written: " + error.what() + ", or leave the array out.");
    }
    const bool whole = vector || components == 1;
    grid->setName(whole ? name : name + "_" + std::to_string(first));
    grid->setCreator("Tyndall");
    RestoreMetadata(*grid, field, tyndall::FieldName(name, ""));
    grid->setTransform(place.Transform->copy());
    grid->insertMeta(tyndall::ImageMinKey, openvdb::Vec3IMetadata(place.ExtentMin));
    grid->insertMeta(tyndall::ImageMaxKey, openvdb::Vec3IMetadata(place.ExtentMax));
    grid->insertMeta(tyndall::ImageOriginKey, openvdb::Vec3DMetadata(place.Origin));
    grid->insertMeta(tyndall::ImageSpacingKey, openvdb::Vec3DMetadata(place.Spacing));
    grids.push_back(grid);
  }
}

std::uint32_t CompressionFlags(int compression)
{
  using namespace openvdb::io;
  std::uint32_t flags = COMPRESS_ACTIVE_MASK;
  if (compression == vtkVDBWriter::BLOSC && Archive::hasBloscCompression())
  {
    flags |= COMPRESS_BLOSC;
  }
  else if (compression != vtkVDBWriter::NONE)
  {
    flags |= COMPRESS_ZIP;
  }
  return flags;
}

/// Writes beside the file's place, reads that back as far as its structure goes, and renames it.
void WriteWholeOrNot(const std::string& path, const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata,
  std::uint32_t compression)
{
  const std::string partial = path + ".partial-" + std::to_string(getpid());
  const auto fail = [&](const std::string& why) {
    std::remove(partial.c_str());
    throw InvalidInput("\"" + path + "\" cannot be written: " + why +
      ". Check that its folder is there, may be written to and has room.");
  };
  try
  {
    openvdb::io::File file(partial);
    file.setCompression(compression);
    errno = 0;
    file.write(grids, metadata);
    file.close();
    tyndall::VDBFile written(partial);
    for (const tyndall::VDBGrid& grid : written.Grids())
    {
      written.CheckLeaves(grid);
    }
  }
  catch (const std::exception& error)
  {
    fail(errno != 0 ? std::strerror(errno) : error.what());
  }
  if (std::rename(partial.c_str(), path.c_str()) != 0)
  {
    fail(std::strerror(errno));
  }
}
}

vtkStandardNewMacro(vtkVDBWriter);

vtkVDBWriter::~vtkVDBWriter()
{
  delete[] this->FileName;
}

vtkImageData* vtkVDBWriter::GetImageInput()
{
  return vtkImageData::SafeDownCast(this->GetInput());
}

int vtkVDBWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

void vtkVDBWriter::WriteData()
{
  try
  {
    if (this->FileName == nullptr || this->FileName[0] == '\0')
    {
      this->SetErrorCode(vtkErrorCode::NoFileNameError);
      throw InvalidInput("No file: set FileName.");
    }
    this->SetErrorCode(vtkErrorCode::FileFormatError); // until it is written
    vtkImageData* image = this->GetImageInput();
    if (image == nullptr || image->GetNumberOfCells() == 0)
    {
      throw InvalidInput("\"" + std::string(this->FileName) + "\" is not written: the image has no cells.");
    }
    vtkSmartPointer<vtkImageData> cells = image;
    if (image->GetPointData()->GetNumberOfArrays() > 0)
    {
      vtkNew<vtkPointDataToCellData> average;
      average->SetInputData(image);
      average->Update();
      cells = vtkImageData::SafeDownCast(average->GetOutput());
    }

    openvdb::initialize();
    const Placement place = PlacementOf(image);
    const Options options{ this->Background, this->Tolerance, this->SaveAsHalf };
    vtkFieldData* field = image->GetFieldData();
    openvdb::GridPtrVec grids;
    const auto addAll = [&](vtkFieldData* arrays, const vtkFieldData* before) {
      for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
      {
        vtkDataArray* array = vtkDataArray::SafeDownCast(arrays->GetAbstractArray(i));
        if (array && (before == nullptr || !const_cast<vtkFieldData*>(before)->HasArray(array->GetName())))
        {
          AddGrids(grids, array, field, place, options);
          this->UpdateProgress(0.5 * (i + 1) / arrays->GetNumberOfArrays());
        }
      }
    };
    addAll(image->GetCellData(), nullptr);
    if (cells != image)
    {
      addAll(cells->GetCellData(), image->GetCellData());
    }
    if (grids.empty())
    {
      throw InvalidInput("\"" + std::string(this->FileName) + "\" is not written: the image has no arrays.");
    }
    openvdb::MetaMap metadata;
    RestoreMetadata(metadata, field, tyndall::FieldName("", ""));
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError);
    WriteWholeOrNot(this->FileName, grids, metadata, CompressionFlags(this->Compression));
    this->SetErrorCode(vtkErrorCode::NoError);
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("The machine's memory does not suffice to write the image as a tree. Write fewer arrays at a time.");
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
}

void vtkVDBWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "Compression: " << this->Compression << "\n";
  os << indent << "Background: " << this->Background << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "SaveAsHalf: " << (this->SaveAsHalf ? "on" : "off") << "\n";
}
