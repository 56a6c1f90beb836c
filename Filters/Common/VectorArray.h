#pragma once

#include "vtkFloatArray.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <utility>
#include <vector>

namespace tyndall
{
/// A vtkFloatArray (vtkUnsignedCharArray), to the last bit of its name, whose first values live in a vector: what
/// kernels return becomes VTK's without a copy.
template <class Array>
class VectorArray : public Array
{
public:
  using Value = typename Array::ValueType;

  static VectorArray* New() { VTK_STANDARD_NEW_BODY(VectorArray); }

  void Take(std::vector<Value>&& values)
  {
    this->Values = std::move(values);
    this->SetArray(this->Values.data(), static_cast<vtkIdType>(this->Values.size()), 1);
  }

private:
  std::vector<Value> Values;
};

/// @param values  tuples of `components` one after the other
template <class Array, class Value = typename Array::ValueType>
vtkSmartPointer<Array> ArrayOf(const char* name, std::vector<Value>&& values, int components)
{
  auto array = vtkSmartPointer<VectorArray<Array>>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->Take(std::move(values));
  return array;
}
}
