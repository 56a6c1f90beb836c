#pragma once

#include "vtkBuffer.h"
#include "vtkFloatArray.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <utility>
#include <vector>

namespace tyndall
{
/// Memory of a vtkAOSDataArrayTemplate that is a vector's, whoever holds it last: arrays that are shallow copies of
/// each other share it.
template <class Value>
class VectorBuffer : public vtkBuffer<Value>
{
public:
  static VectorBuffer* New() { VTK_STANDARD_NEW_BODY(VectorBuffer); }

  std::vector<Value> Values;
};

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
    auto* const buffer = VectorBuffer<Value>::New();
    buffer->Values = std::move(values);
    this->Buffer->UnRegister(nullptr);
    this->Buffer = buffer;
    this->SetArray(buffer->Values.data(), static_cast<vtkIdType>(buffer->Values.size()), 1);
  }
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
