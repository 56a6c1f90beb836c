#include "IO/VDB/VDBMetadata.h"

#include "Common/LightTransportData.h"
#include "IO/VDB/VDBFile.h"
#include "IO/VDB/VDBGeometry.h"
#include "Numerics/NumberText.h"

#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <tuple>
#include <vector>

namespace tyndall
{
namespace
{
/// Correspondence between metadata of OpenVDB's type V, with N numbers, and the type A of the VTK array that holds them
/// as one tuple.
template <typename V, typename A, int N = 1>
struct ValueKind
{
  using Value = V;
  using Array = A;
  static constexpr int Count = N;
};

using namespace openvdb;
constexpr std::tuple<ValueKind<bool, vtkUnsignedCharArray>, ValueKind<Int32, vtkIntArray>,
  ValueKind<Int64, vtkTypeInt64Array>, ValueKind<float, vtkFloatArray>, ValueKind<double, vtkDoubleArray>,
  ValueKind<Vec2i, vtkIntArray, 2>, ValueKind<Vec2s, vtkFloatArray, 2>, ValueKind<Vec2d, vtkDoubleArray, 2>,
  ValueKind<Vec3i, vtkIntArray, 3>, ValueKind<Vec3s, vtkFloatArray, 3>, ValueKind<Vec3d, vtkDoubleArray, 3>,
  ValueKind<Vec4i, vtkIntArray, 4>, ValueKind<Vec4s, vtkFloatArray, 4>, ValueKind<Vec4d, vtkDoubleArray, 4>,
  ValueKind<Mat4s, vtkFloatArray, 16>, ValueKind<Mat4d, vtkDoubleArray, 16>>
  Kinds;

/// Calls `act` with each ValueKind (type of metadata and of VTK array) in turn, until `act` returns true.
template <typename Do>
void ForKinds(const Do& act)
{
  std::apply([&](auto... kind) { (act(kind) || ...); }, Kinds);
}

template <typename K>
bool AddIfOfKind(K, vtkFieldData* field, const std::string& name, const Metadata& metadata)
{
  const auto* typed = dynamic_cast<const TypedMetadata<typename K::Value>*>(&metadata);
  if (typed == nullptr)
  {
    return false;
  }
  vtkNew<typename K::Array> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(K::Count);
  array->SetNumberOfTuples(1);
  if constexpr (K::Count == 1)
  {
    array->SetValue(0, typed->value());
  }
  else
  {
    std::copy_n(typed->value().asPointer(), K::Count, array->GetPointer(0));
  }
  field->AddArray(array);
  return true;
}

template <typename K>
bool InsertIfOfKind(K, MetaMap& map, const std::string& key, vtkAbstractArray* found)
{
  auto* array = K::Array::SafeDownCast(found);
  if (array == nullptr || array->GetNumberOfValues() != K::Count)
  {
    return false;
  }
  if constexpr (K::Count == 1)
  {
    map.insertMeta(key, TypedMetadata<typename K::Value>(static_cast<typename K::Value>(array->GetValue(0))));
  }
  else
  {
    map.insertMeta(key, TypedMetadata<typename K::Value>(typename K::Value(array->GetPointer(0))));
  }
  return true;
}

/// Adds metadata `key` from a VTK array, if the array holds one 64-bit integer of any VTK type.
/// @return whether the array holds such a number
bool InsertIfLong(MetaMap& map, const std::string& key, vtkAbstractArray* found)
{
  auto* array = vtkDataArray::SafeDownCast(found);
  if (array == nullptr || array->GetDataTypeSize() != 8 || array->GetDataType() == VTK_DOUBLE ||
    array->GetNumberOfValues() != 1)
  {
    return false;
  }
  map.insertMeta(key, Int64Metadata(*static_cast<const Int64*>(array->GetVoidPointer(0))));
  return true;
}

void AddOne(vtkDataObject* image, const std::string& name, const Metadata& value)
{
  if (const auto* text = dynamic_cast<const StringMetadata*>(&value))
  {
    AddFact(image, name.c_str(), std::vector<std::string>{ text->value() });
    return;
  }
  ForKinds([&](auto kind) { return AddIfOfKind(kind, image->GetFieldData(), name, value); });
}

void InsertOne(MetaMap& map, const std::string& key, vtkAbstractArray* array)
{
  map.removeMeta(key);
  if (auto* text = vtkStringArray::SafeDownCast(array))
  {
    if (text->GetNumberOfValues() == 1)
    {
      map.insertMeta(key, StringMetadata(text->GetValue(0)));
    }
  }
  else if (!InsertIfLong(map, key, array))
  {
    ForKinds([&](auto kind) { return InsertIfOfKind(kind, map, key, array); });
  }
}

struct MediumFact
{
  const char* Field;
  const char* Key;
};
constexpr MediumFact MediumFacts[] = { { "g", "medium_g" }, { "phase_function", "medium_phase_function" },
  { "phase_second_g", "medium_phase_second_g" }, { "phase_first_part", "medium_phase_first_part" } };
/// Columns of a phase function's table: names of field data and of metadata. OpenVDB has no type for an array of any
/// length, so that the numbers are stored as text.
constexpr MediumFact MediumTables[] = { { "phase_cosine", "medium_phase_cosine" },
  { "phase_value", "medium_phase_value" } };

/// Writes all numbers of an array with all of their digits, separated by blanks.
std::string TextOf(vtkDataArray* array)
{
  std::string text;
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    const int components = array->GetNumberOfComponents();
    text += (i > 0 ? " " : "") + Text("%.17g", array->GetComponent(i / components, static_cast<int>(i % components)));
  }
  return text;
}

std::vector<double> NumbersOf(const std::string& text)
{
  std::vector<double> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;)
  {
    numbers.push_back(NumberIn(word).value_or(0.0)); // an invalid number becomes 0
  }
  return numbers;
}

bool IsMediumFact(const std::string& key)
{
  const auto is = [&](const MediumFact& fact) { return key == fact.Key; };
  return std::any_of(std::begin(MediumFacts), std::end(MediumFacts), is) ||
    std::any_of(std::begin(MediumTables), std::end(MediumTables), is);
}
}

void AddMetadata(vtkDataObject* image, const std::string& prefix, const MetaMap& map)
{
  for (auto entry = map.beginMeta(); entry != map.endMeta(); ++entry)
  {
    if (!IsGeometry(entry->first) && !IsMediumFact(entry->first))
    {
      AddOne(image, prefix + entry->first, *entry->second);
    }
  }
}

void RestoreMetadata(MetaMap& map, vtkFieldData* field, const std::string& prefix)
{
  for (int i = 0; i < field->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = field->GetAbstractArray(i);
    const std::string name = array->GetName() ? array->GetName() : "";
    const bool ours = name.size() > prefix.size() && name.compare(0, prefix.size(), prefix) == 0;
    const std::string key = ours ? name.substr(prefix.size()) : std::string();
    if (!ours || key == "background" || key == "type" || DescribesTheFile(key))
    {
      continue;
    }
    InsertOne(map, key, array);
  }
}

void AddMediumFacts(vtkDataObject* image, const MetaMap& file)
{
  for (const MediumFact& fact : MediumFacts)
  {
    if (const Metadata::ConstPtr value = file[fact.Key])
    {
      AddOne(image, fact.Field, *value);
    }
  }
  for (const MediumFact& table : MediumTables)
  {
    if (const auto text = file.getMetadata<StringMetadata>(table.Key))
    {
      AddFact(image, table.Field, NumbersOf(text->value()));
    }
  }
}

void NoteMediumFacts(MetaMap& file, vtkFieldData* field)
{
  for (const MediumFact& fact : MediumFacts)
  {
    if (vtkAbstractArray* array = field->GetAbstractArray(fact.Field))
    {
      InsertOne(file, fact.Key, array);
    }
  }
  for (const MediumFact& table : MediumTables)
  {
    if (vtkDataArray* array = field->GetArray(table.Field))
    {
      file.insertMeta(table.Key, StringMetadata(TextOf(array)));
    }
  }
}
}
