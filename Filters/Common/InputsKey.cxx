#include "Common/InputsKey.h"

#include "vtkCellArray.h"
#include "vtkMatrix3x3.h"
#include "vtkPolyData.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace tyndall
{
namespace
{
/// A hash similar to FNV that processes eight bytes at a time.
class Digest
{
public:
  void Add(std::uint64_t word)
  {
    this->State = (this->State ^ word) * 0x9E3779B97F4A7C15u;
    this->State ^= this->State >> 29;
  }

  void AddBytes(const void* bytes, std::size_t count)
  {
    const auto* at = static_cast<const unsigned char*>(bytes);
    for (std::size_t done = 0; done < count; done += sizeof(std::uint64_t))
    {
      std::uint64_t word = 0;
      std::memcpy(&word, at + done, std::min(sizeof(word), count - done));
      this->Add(word);
    }
    this->Add(count);
  }

  void AddText(const char* text)
  {
    const std::string all = text ? text : "";
    this->AddBytes(all.data(), all.size());
  }

  std::uint64_t Value() const { return this->State; }

private:
  std::uint64_t State = 0xCBF29CE484222325u;
};

void AddArray(Digest& digest, vtkAbstractArray* array)
{
  digest.AddText(array->GetName());
  digest.Add(static_cast<std::uint64_t>(array->GetDataType()));
  digest.Add(static_cast<std::uint64_t>(array->GetNumberOfComponents()));
  const vtkIdType count = array->GetNumberOfValues();
  auto* const numbers = vtkDataArray::SafeDownCast(array);
  if (numbers && numbers->HasStandardMemoryLayout())
  {
    digest.AddBytes(
      numbers->GetVoidPointer(0), static_cast<std::size_t>(count) * static_cast<std::size_t>(array->GetDataTypeSize()));
    return;
  }
  for (vtkIdType i = 0; i < count; ++i)
  {
    digest.AddText(array->GetVariantValue(i).ToString().c_str());
  }
}

void AddImage(Digest& digest, vtkImageData* image)
{
  digest.AddBytes(image->GetExtent(), 6 * sizeof(int));
  digest.AddBytes(image->GetSpacing(), 3 * sizeof(double));
  digest.AddBytes(image->GetOrigin(), 3 * sizeof(double));
  digest.AddBytes(image->GetDirectionMatrix()->GetData(), 9 * sizeof(double));
}

void AddCellArray(Digest& digest, vtkCellArray* cells)
{
  if (cells)
  {
    AddArray(digest, cells->GetOffsetsArray());
    AddArray(digest, cells->GetConnectivityArray());
  }
}

/// Hash of a dataset: its class, grid, points, cells and arrays.
/// @param data  null: no dataset
/// @param kinds  attribute types of the arrays to include: vtkDataObject::POINT, CELL, FIELD, ROW
std::uint64_t KeyOf(vtkDataObject* data, const std::vector<int>& kinds)
{
  Digest digest;
  digest.AddText(data ? data->GetClassName() : nullptr);
  for (const int kind : kinds)
  {
    vtkFieldData* const arrays = data ? data->GetAttributesAsFieldData(kind) : nullptr;
    digest.Add(static_cast<std::uint64_t>(kind));
    for (int i = 0; arrays && i < arrays->GetNumberOfArrays(); ++i)
    {
      AddArray(digest, arrays->GetAbstractArray(i));
    }
  }
  if (auto* const image = vtkImageData::SafeDownCast(data))
  {
    AddImage(digest, image);
  }
  auto* const set = vtkPointSet::SafeDownCast(data);
  if (set && set->GetPoints())
  {
    AddArray(digest, set->GetPoints()->GetData());
  }
  if (auto* const shape = vtkPolyData::SafeDownCast(data))
  {
    for (vtkCellArray* cells : { shape->GetVerts(), shape->GetLines(), shape->GetPolys(), shape->GetStrips() })
    {
      AddCellArray(digest, cells);
    }
  }
  return digest.Value();
}
}

std::uint64_t ContentKey(vtkDataObject* data)
{
  return KeyOf(data, { vtkDataObject::POINT, vtkDataObject::CELL, vtkDataObject::FIELD, vtkDataObject::ROW });
}

std::uint64_t ContentKeyButFacts(vtkDataObject* data)
{
  return KeyOf(data, { vtkDataObject::POINT, vtkDataObject::CELL, vtkDataObject::ROW });
}
}
