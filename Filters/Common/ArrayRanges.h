#pragma once

#include "vtkBuffer.h"
#include "vtkFloatArray.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

class vtkDataArray;

/// Ranges (smallest and largest value) of arrays, computed in parallel when the values are produced. They are stored in
/// the array's vtkInformation, where VTK and ParaView look for a range before they compute one. ParaView requests the
/// range of every component and of the tuples' norm of every output array; VTK computes each of them in a separate pass
/// on one core.
namespace tyndall
{
struct ArrayRanges
{
  std::vector<std::array<double, 2>> components; ///< range of each component; empty: there are no values
  /// Range of the Euclidean norm of the tuples; double, as in vtkDataArray.
  std::array<double, 2> norm = {};
  /// Index of the first value that is infinite or NaN; the number of values if all are finite.
  std::size_t firstNotFinite = 0;
};

/// Computes the ranges of an array's values. If a value is not finite, only firstNotFinite of the result is valid.
/// @param count  number of values: components times tuples
ArrayRanges RangesOf(const float* values, std::size_t count, int components);

/// Stores ranges in the information of an array, where VTK looks for them. To be called when the array's values (all
/// finite), its name and its number of components are final: Modified() removes stored ranges.
void LeaveRanges(const ArrayRanges& ranges, vtkDataArray* array);

/// Copies the ranges that are stored in the array `from`, if any, to `array`, which must have the same values.
void LeaveSameRanges(vtkDataArray* from, vtkDataArray* array);

/// Computes and stores the ranges of an array. Does nothing if a value is not finite, or unless the array is an array
/// of structures (AOS) of float, double, int or unsigned char.
void LeaveRanges(vtkDataArray* array);

/// Memory buffer of a vtkAOSDataArrayTemplate, owned by a std::vector. The buffer is reference counted: shallow copies
/// of an array share it.
template <class Value>
class VectorBuffer : public vtkBuffer<Value>
{
public:
  static VectorBuffer* New() { VTK_STANDARD_NEW_BODY(VectorBuffer); }

  std::vector<Value> Values;
};

/// A vtkFloatArray or vtkUnsignedCharArray (`Array`) whose initial values are stored in a std::vector, so that results
/// of kernels become VTK arrays without a copy. It behaves like its superclass, and has the same class name.
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

/// Makes a VTK array of the values of a vector, without a copy.
/// @param values  tuples of `components` values each
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
