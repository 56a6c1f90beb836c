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
/// A memory buffer of a vtkAOSDataArrayTemplate that is owned by a std::vector. It is reference counted: arrays that
/// are shallow copies of each other share it.
template <class Value>
class VectorBuffer : public vtkBuffer<Value>
{
public:
  static VectorBuffer* New() { VTK_STANDARD_NEW_BODY(VectorBuffer); }

  std::vector<Value> Values;
};

/// A vtkFloatArray (vtkUnsignedCharArray) whose initial values are stored in a std::vector, so that results of kernels
/// become VTK arrays without a copy. It behaves like its superclass, and has the same class name.
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

/// Makes a VTK array from a vector without a copy.
/// @param values  tuples of `components` values, one after the other
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
