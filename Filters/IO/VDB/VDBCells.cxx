#include "IO/VDB/VDBCells.h"

#include "Common/LightTransportData.h"
#include "Device/Errors.h"
#include "IO/VDB/VDBFile.h"
#include "IO/VDB/VDBMetadata.h"
#include "IO/VDB/VDBTreeWalk.h"
#include "Numerics/NumberText.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace tyndall
{
/// Largest accepted relative error from storing a number in 16 bits: twice the rounding error of 11 significant bits,
/// so only numbers below 2^-14, which have fewer bits, can exceed it.
constexpr double LargestHalfLoss = 1e-3;

/// Whether a real number can be stored in 16 bits, rounded as OpenVDB does, without overflow or a relative error above
/// LargestHalfLoss. True for infinity and NaN.
template <typename Real>
bool FitsHalf(Real number)
{
  const double kept = openvdb::io::truncateRealToHalf(number), exact = number;
  return !std::isfinite(exact) || (std::isfinite(kept) && std::abs(kept - exact) <= LargestHalfLoss * std::abs(exact));
}

/// Checks that all numbers of a value can be stored in 16 bits (FitsHalf); does nothing for types that are not stored
/// in 16 bits.
/// @param where  describes the position of the value, e.g. "in voxel (1, 2, 3)"
/// @throws InvalidInput with the end of a sentence about the array, if a number of the value does not fit
template <typename Value, typename Where>
void RequireHalf(const Value& value, const Where& where)
{
  if constexpr (openvdb::VecTraits<Value>::IsVec)
  {
    for (int component = 0; component < 3; ++component)
    {
      RequireHalf(value[component], where);
    }
  }
  else if constexpr (std::is_floating_point<Value>::value)
  {
    if (FitsHalf(value))
    {
      return;
    }
    throw InvalidInput("its value " + Text(sizeof(Value) > 4 ? "%.17g" : "%.9g", value) + " " + where() +
      (std::abs(value) > 1 ? " exceeds 65504, the largest number of 16 bits"
                           : " would lose more than 0.1% in 16 bits, which end at 6e-8") +
      ". Switch SaveAsHalf off");
  }
}

namespace
{
/// A type of grid: OpenVDB's type G, and the type A of the VTK cell array, with N numbers per voxel.
template <typename G, typename A, int N = 1>
struct GridKind
{
  using Grid = G;
  using Array = A;
  using Number = typename A::ValueType;
  static constexpr int Count = N;
};

/// Calls `act` with the GridKind (types of grid and array) of the value type `type`, a name that FindValueType accepts.
template <typename Do>
void WithKind(const std::string& type, const Do& act)
{
  using namespace openvdb;
  type == "float"      ? act(GridKind<FloatGrid, vtkFloatArray>())
    : type == "double" ? act(GridKind<DoubleGrid, vtkDoubleArray>())
    : type == "int32"  ? act(GridKind<Int32Grid, vtkIntArray>())
    : type == "int64"  ? act(GridKind<Int64Grid, vtkTypeInt64Array>())
    : type == "bool"   ? act(GridKind<BoolGrid, vtkUnsignedCharArray>())
    : type == "mask"   ? act(GridKind<MaskGrid, vtkUnsignedCharArray>())
    : type == "vec3i"  ? act(GridKind<Vec3IGrid, vtkIntArray, 3>())
    : type == "vec3s"  ? act(GridKind<Vec3SGrid, vtkFloatArray, 3>())
                       : act(GridKind<Vec3DGrid, vtkDoubleArray, 3>());
}

template <typename K>
void AddCellsOf(
  K, const openvdb::GridBase& grid, const std::string& name, const openvdb::CoordBBox& box, vtkImageData* image)
{
  using Number = typename K::Number;
  using Voxel = std::conditional_t<K::Count == 1, Number, openvdb::math::Vec3<Number>>;
  const auto& tree = static_cast<const typename K::Grid&>(grid).tree();
  vtkNew<typename K::Array> cells;
  cells->SetName(name.c_str());
  cells->SetNumberOfComponents(K::Count);
  cells->SetNumberOfTuples(image->GetNumberOfCells());
  openvdb::tools::Dense<Voxel, openvdb::tools::LayoutXYZ> dense(box, reinterpret_cast<Voxel*>(cells->GetPointer(0)));
  openvdb::tools::copyToDense(tree, dense);
  image->GetCellData()->AddArray(cells);

  const Voxel value(tree.background());
  vtkNew<typename K::Array> background;
  background->SetName(FieldName(name, "background").c_str());
  background->SetNumberOfComponents(K::Count);
  background->SetNumberOfTuples(1);
  std::memcpy(background->GetPointer(0), &value, sizeof(value));
  image->GetFieldData()->AddArray(background);
}

/// Converts numbers of a VTK array of any type to the grid's type Number.
template <typename Number>
class Numbers
{
public:
  /// A voxel's value consists of the array's components from number `first` on.
  Numbers(vtkDataArray* array, int first)
    : Values(array->GetVoidPointer(0))
    , Components(array->GetNumberOfComponents())
    , First(first)
  {
    switch (array->GetDataType())
    {
      vtkTemplateMacro(this->ReadOne = &Numbers::Read<VTK_TT>);
      default: throw InvalidInput("its type " + std::string(array->GetDataTypeAsString()) + " has no grid. Convert it");
    }
  }

  Number At(vtkIdType cell, int component) const
  {
    return this->ReadOne(this->Values, cell * this->Components + this->First + component, cell);
  }

private:
  template <typename T>
  static Number Read(const void* values, vtkIdType at, [[maybe_unused]] vtkIdType cell)
  {
    const T value = static_cast<const T*>(values)[at];
    if constexpr (std::is_same<Number, vtkTypeInt64>::value && std::is_unsigned<T>::value && sizeof(T) == 8)
    {
      if (value > static_cast<T>(INT64_MAX))
      {
        throw InvalidInput("its value " + std::to_string(value) + " in cell " + std::to_string(cell) +
          " is above 2^63 - 1, the largest integer of a .vdb file. Convert the array to double");
      }
    }
    return static_cast<Number>(value);
  }

  const void* Values;
  int Components;
  int First;
  Number (*ReadOne)(const void*, vtkIdType, vtkIdType) = nullptr;
};

/// Makes the value of a voxel, a scalar or a vector, from the numbers of its components.
/// @param number  function that returns the number in the component of a given index
template <typename Value, typename Get>
Value VoxelFrom(const Get& number)
{
  if constexpr (openvdb::VecTraits<Value>::IsVec)
  {
    using Number = typename Value::ValueType;
    return Value(static_cast<Number>(number(0)), static_cast<Number>(number(1)), static_cast<Number>(number(2)));
  }
  else if constexpr (std::is_same<Value, bool>::value)
  {
    return number(0) != 0;
  }
  else
  {
    return static_cast<Value>(number(0));
  }
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
    return std::abs(static_cast<double>(a) - static_cast<double>(b)) <= tolerance; // false for NaN
  }
}

std::string ToString(const openvdb::Coord& voxel)
{
  return "(" + std::to_string(voxel[0]) + ", " + std::to_string(voxel[1]) + ", " + std::to_string(voxel[2]) + ")";
}

/// Fills one block of a tree, no larger than a leaf: a block of background is skipped, a block of equal values becomes
/// a tile.
/// @param valueAt  returns the value of a voxel
template <typename TreeT, typename ValueAt>
void FillBlock(TreeT& tree, openvdb::CoordBBox block, const openvdb::CoordBBox& voxels, const VoxelOptions& options,
  const ValueAt& valueAt)
{
  using Value = typename TreeT::ValueType;
  const auto same = [&](const Value& a, const Value& b) {
    return SameBits(a, b) || (options.Tolerance > 0.0 && Near(a, b, options.Tolerance));
  };
  const openvdb::Coord corner = block.min();
  const Value background = tree.background();
  bool constant = voxels.isInside(block);
  block.intersect(voxels);
  typename TreeT::LeafNodeType* leaf = nullptr;
  Value one = background;
  for (const openvdb::Coord& voxel : block)
  {
    const Value value = valueAt(voxel);
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
    if (options.Half)
    {
      RequireHalf(value, [&] { return "in voxel " + ToString(voxel); });
    }
    constant = constant && same(value, one);
    leaf->setValueOn(voxel, value);
  }
  if (leaf != nullptr && constant)
  {
    tree.addTile(1, corner, one, true);
  }
}

/// Fills a tree with the values of an array, block by block, without making leaves for blocks of background.
template <typename TreeT, typename Number>
void FillTree(
  TreeT& tree, const Numbers<Number>& numbers, const openvdb::CoordBBox& voxels, const VoxelOptions& options)
{
  constexpr std::int64_t size = TreeT::LeafNodeType::DIM;
  const openvdb::Coord &low = voxels.min(), &high = voxels.max(), cells = voxels.dim();
  const auto valueAt = [&](const openvdb::Coord& voxel) -> typename TreeT::ValueType {
    const openvdb::Coord at = voxel - low;
    const vtkIdType cell =
      at[0] + static_cast<vtkIdType>(cells[0]) * (at[1] + static_cast<vtkIdType>(cells[1]) * at[2]);
    if (options.Hidden && (*options.Hidden)[static_cast<std::size_t>(cell)])
    {
      return tree.background();
    }
    return VoxelFrom<typename TreeT::ValueType>([&](int component) { return numbers.At(cell, component); });
  };
  const auto blockStart = [&](int axis) { return static_cast<std::int64_t>(low[axis] & ~(int(size) - 1)); };
  for (std::int64_t x = blockStart(0); x <= high[0]; x += size)
  {
    for (std::int64_t y = blockStart(1); y <= high[1]; y += size)
    {
      for (std::int64_t z = blockStart(2); z <= high[2]; z += size)
      {
        const openvdb::Coord corner(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
        FillBlock(tree, openvdb::CoordBBox::createCube(corner, size), voxels, options, valueAt);
      }
    }
  }
}

/// Finds the field data array `key` that belongs to the cell array `array`; null if missing or of a type other than
/// ArrayT.
template <typename ArrayT>
ArrayT* FactOf(vtkFieldData* field, const std::string& array, const char* key)
{
  return ArrayT::SafeDownCast(field->GetAbstractArray(FieldName(array, key).c_str()));
}

/// Background of an array's grid: the value in the array's field data, otherwise the value `otherwise` for each
/// component.
template <typename K>
typename K::Grid::ValueType BackgroundOf(K, const std::string& array, vtkFieldData* field, double otherwise)
{
  using Value = typename K::Grid::ValueType;
  vtkDataArray* noted = FactOf<vtkDataArray>(field, array, "background");
  if (noted == nullptr || noted->GetNumberOfValues() != K::Count)
  {
    return VoxelFrom<Value>([&](int) { return otherwise; });
  }
  const Numbers<typename K::Number> numbers(noted, 0);
  return VoxelFrom<Value>([&](int component) { return numbers.At(0, component); });
}

/// Type of the grids that an array becomes, and number of the array's components in each grid.
struct GridsOfArray
{
  std::string Type;
  int Components;
};

GridsOfArray ChooseGrids(vtkDataArray* array, const std::string& noted)
{
  const int type = array->GetDataType();
  const bool vector = array->GetNumberOfComponents() == 3;
  if (type == VTK_FLOAT || type == VTK_DOUBLE)
  {
    const std::string real = type == VTK_FLOAT ? "float" : "double";
    return vector ? GridsOfArray{ type == VTK_FLOAT ? "vec3s" : "vec3d", 3 } : GridsOfArray{ real, 1 };
  }
  if (array->GetDataTypeSize() > 4 || type == VTK_UNSIGNED_INT)
  {
    return { "int64", 1 };
  }
  if (vector)
  {
    return { "vec3i", 3 };
  }
  const bool binary = type == VTK_UNSIGNED_CHAR && (noted == "bool" || noted == "mask");
  return { binary ? noted : "int32", 1 };
}

template <typename K>
openvdb::GridBase::Ptr MakeGrid(K kind, vtkDataArray* array, int first, const std::string& type, vtkFieldData* field,
  const openvdb::CoordBBox& voxels, const VoxelOptions& options)
{
  using Value = typename K::Grid::ValueType;
  const openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid(FindValueType(type)->GridType());
  auto& tree = static_cast<typename K::Grid&>(*grid).tree();
  const Value background = BackgroundOf(kind, array->GetName() ? array->GetName() : "", field, options.Background);
  tree.root().setBackground(background, /*updateChildNodes=*/false);
  if (options.Half)
  {
    RequireHalf(background, [] { return "as background"; });
  }
  FillTree(tree, Numbers<typename K::Number>(array, first), voxels, options);
  if (std::is_floating_point<Value>::value && background == openvdb::zeroVal<Value>())
  {
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  }
  grid->setSaveFloatAsHalf(options.Half);
  return grid;
}
}

void AddGridCells(const openvdb::GridBase& grid, const std::string& type, const std::string& name,
  const openvdb::CoordBBox& box, vtkImageData* image)
{
  WithKind(type, [&](auto kind) { AddCellsOf(kind, grid, name, box, image); });
  AddFact(image, FieldName(name, "type").c_str(), std::vector<std::string>{ type });
}

namespace
{
/// Interpolates a grid within a box of voxels: linearly between voxel centres; integers are taken from the nearest
/// voxel.
template <typename K>
class BoxSampler
{
public:
  using Number = typename K::Number;

  BoxSampler(const openvdb::CoordBBox& box, const Number* values, const Number* background)
    : Low(box.min())
    , Size(box.dim())
    , Values(values)
    , Background(background)
  {
  }

  /// Interpolates the grid at a position.
  /// @param at  position in index space, where voxel centres have whole numbers
  /// @param value  set to the numbers of the interpolated value
  void Sample(const openvdb::Vec3d& at, Number* value) const
  {
    if constexpr (std::is_integral<Number>::value)
    {
      const Number* const nearest = this->At(openvdb::Coord::round(at));
      std::copy_n(nearest, K::Count, value);
    }
    else
    {
      const openvdb::Coord first = openvdb::Coord::floor(at);
      double sum[K::Count] = {};
      for (int corner = 0; corner < 8; ++corner)
      {
        const openvdb::Coord voxel = first.offsetBy(corner & 1, corner >> 1 & 1, corner >> 2);
        double weight = 1.0;
        for (int axis = 0; axis < 3; ++axis)
        {
          weight *= 1.0 - std::abs(at[axis] - voxel[axis]);
        }
        const Number* const there = this->At(voxel);
        for (int c = 0; c < K::Count && weight > 0.0; ++c)
        {
          sum[c] += weight * static_cast<double>(there[c]);
        }
      }
      std::transform(sum, sum + K::Count, value, [](double number) { return static_cast<Number>(number); });
    }
  }

private:
  const Number* At(const openvdb::Coord& voxel) const
  {
    const openvdb::Coord at = voxel - this->Low;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (at[axis] < 0 || at[axis] >= this->Size[axis])
      {
        return this->Background;
      }
    }
    const vtkIdType cell =
      at[0] + static_cast<vtkIdType>(this->Size[0]) * (at[1] + static_cast<vtkIdType>(this->Size[1]) * at[2]);
    return this->Values + cell * K::Count;
  }

  openvdb::Coord Low, Size;
  const Number *Values, *Background;
};

template <typename K>
void AddResampledOf(K, vtkImageData* cells, const VDBGrid& grid, const openvdb::CoordBBox& box, vtkImageData* image)
{
  auto* const given = K::Array::SafeDownCast(cells->GetCellData()->GetArray(grid.Name.c_str()));
  auto* const background = FactOf<typename K::Array>(cells->GetFieldData(), grid.Name, "background");
  vtkNew<typename K::Array> values;
  values->SetName(grid.Name.c_str());
  values->SetNumberOfComponents(K::Count);
  values->SetNumberOfTuples(image->GetNumberOfCells());
  openvdb::Mat3d steps;
  for (int axis = 0; axis < 3; ++axis)
  {
    steps.setRow(axis, openvdb::Vec3d(grid.Axes[axis].data()));
  }
  const openvdb::Mat3d toIndex = steps.inverse();
  const openvdb::Vec3d zero(grid.Translation.data());
  const BoxSampler<K> sampler(box, given->GetPointer(0), background->GetPointer(0));
  const int* const extent = image->GetExtent();
  const double *origin = image->GetOrigin(), *spacing = image->GetSpacing();
  typename K::Number* to = values->GetPointer(0);
  for (int k = extent[4]; k < extent[5]; ++k)
  {
    for (int j = extent[2]; j < extent[3]; ++j)
    {
      for (int i = extent[0]; i < extent[1]; ++i, to += K::Count)
      {
        const openvdb::Vec3d middle(
          origin[0] + (i + 0.5) * spacing[0], origin[1] + (j + 0.5) * spacing[1], origin[2] + (k + 0.5) * spacing[2]);
        sampler.Sample(toIndex.transform(middle - zero), to);
      }
    }
  }
  image->GetCellData()->AddArray(values);
}
}

void AddResampled(vtkImageData* cells, const VDBGrid& grid, const openvdb::CoordBBox& box, vtkImageData* image)
{
  WithKind(grid.Type, [&](auto kind) { AddResampledOf(kind, cells, grid, box, image); });
  for (const char* fact : { "background", "type" })
  {
    image->GetFieldData()->AddArray(cells->GetFieldData()->GetAbstractArray(FieldName(grid.Name, fact).c_str()));
  }
}

namespace
{
template <typename ArrayT>
bool MakeFog(vtkImageData* image, vtkDataArray* distances, const std::string& kind)
{
  using Value = typename ArrayT::ValueType;
  const std::string name = distances->GetName();
  auto* const cells = ArrayT::SafeDownCast(distances);
  auto* const background = FactOf<ArrayT>(image->GetFieldData(), name, "background");
  if (!cells || !background || cells->GetNumberOfComponents() != 1)
  {
    return false;
  }
  Value* const values = cells->GetPointer(0);
  Value* const end = values + cells->GetNumberOfTuples();
  const bool looksSo = kind != "fog volume" && kind != "staggered" && background->GetValue(0) > 0 &&
    std::any_of(values, end, [](Value value) { return value < 0; });
  if (kind != "level set" && !looksSo)
  {
    return false;
  }
  const double* const spacing = image->GetSpacing();
  const double voxel = *std::min_element(spacing, spacing + 3);
  std::transform(values, end, values, [voxel](Value value) { return FogInside(value, voxel); });
  background->SetValue(0, 0);
  return true;
}
}

void MakeFogOfLevelSet(vtkImageData* image, const std::string& name)
{
  vtkDataArray* const cells = image->GetCellData()->GetArray(name.c_str());
  auto* const noted = FactOf<vtkStringArray>(image->GetFieldData(), name, "class");
  const std::string kind = noted && noted->GetNumberOfValues() == 1 ? std::string(noted->GetValue(0)) : "unknown";
  if (MakeFog<vtkFloatArray>(image, cells, kind) || MakeFog<vtkDoubleArray>(image, cells, kind))
  {
    AddFact(image, FieldName(name, "class").c_str(), std::vector<std::string>{ "fog volume" });
  }
}

openvdb::GridPtrVec MakeGrids(
  vtkDataArray* array, vtkFieldData* field, const openvdb::CoordBBox& voxels, const VoxelOptions& options)
{
  const std::string name = array->GetName() ? array->GetName() : "";
  vtkStringArray* noted = FactOf<vtkStringArray>(field, name, "type");
  const GridsOfArray chosen =
    ChooseGrids(array, noted && noted->GetNumberOfValues() == 1 ? noted->GetValue(0) : std::string());
  openvdb::GridPtrVec grids;
  try
  {
    for (int first = 0; first < array->GetNumberOfComponents(); first += chosen.Components)
    {
      const bool whole = chosen.Components == array->GetNumberOfComponents();
      WithKind(chosen.Type,
        [&](auto kind) { grids.push_back(MakeGrid(kind, array, first, chosen.Type, field, voxels, options)); });
      grids.back()->setName(whole ? name : name + "_" + std::to_string(first));
    }
  }
  catch (const InvalidInput& error)
  {
    throw InvalidInput("Array \"" + name + "\" cannot be written: " + error.what() + ", or leave the array out.");
  }
  return grids;
}
}
