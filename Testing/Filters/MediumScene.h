#pragma once

#include "TestSupport.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLightPropagationMaps.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"

#include <array>
#include <functional>

/// Small media for the tests of filters.
namespace test
{
struct Box
{
  std::array<int, 3> cells = { 4, 4, 4 };
  std::array<double, 3> spacing = { 1.0, 1.0, 1.0 };
  std::array<double, 3> origin = { 0.0, 0.0, 0.0 };
  std::array<int, 3> firstIndex = { 0, 0, 0 };
};

inline vtkSmartPointer<vtkImageData> MakeImage(const Box& box)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  int extent[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[2 * axis] = box.firstIndex[axis];
    extent[2 * axis + 1] = box.firstIndex[axis] + box.cells[axis];
  }
  image->SetExtent(extent);
  image->SetSpacing(box.spacing.data());
  image->SetOrigin(box.origin.data());
  return image;
}

/// value(i, c) for tuple i and component c
using Values = std::function<double(vtkIdType, int)>;

template <class Array>
void AddValues(vtkFieldData* to, const char* name, vtkIdType tuples, int components, const Values& value)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  for (vtkIdType i = 0; i < tuples; ++i)
  {
    for (int c = 0; c < components; ++c)
    {
      array->SetComponent(i, c, value(i, c));
    }
  }
  to->AddArray(array);
}

template <class Array = vtkFloatArray>
void AddCells(vtkImageData* image, const char* name, double value, int components = 1)
{
  AddValues<Array>(
    image->GetCellData(), name, image->GetNumberOfCells(), components, [=](vtkIdType, int) { return value; });
}

template <class Array = vtkFloatArray>
void AddPoints(vtkImageData* image, const char* name, double value, int components = 1)
{
  AddValues<Array>(
    image->GetPointData(), name, image->GetNumberOfPoints(), components, [=](vtkIdType, int) { return value; });
}

/// A uniform medium.
inline vtkSmartPointer<vtkImageData> MakeMedium(const Box& box, double sigma_a, double sigma_s)
{
  auto image = MakeImage(box);
  AddCells(image, "sigma_a", sigma_a);
  AddCells(image, "sigma_s", sigma_s);
  return image;
}

/// Largest deviation of a cell array from a value; infinite where the array is not there.
inline double Deviation(vtkImageData* image, const char* name, double from)
{
  vtkDataArray* array = image->GetCellData()->GetArray(name);
  double largest = array && array->GetNumberOfTuples() > 0 ? 0.0 : VTK_DOUBLE_MAX;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < array->GetNumberOfComponents(); ++c)
    {
      largest = std::max(largest, std::abs(array->GetComponent(i, c) - from));
    }
  }
  return largest;
}

/// Whether solvers have a device to run on.
inline bool HasDevice()
{
  vtkNew<vtkLightPropagationMaps> maps;
  Errors errors(maps);
  maps->SetInputDataObject(MakeMedium({ { 1, 1, 1 } }, 1.0, 0.0));
  maps->SetSkyColor(1.0, 1.0, 1.0);
  maps->Update();
  return errors.None();
}

/// Runs a test that needs an OpenCL device.
/// @param claims  those that needed none: if one of them failed, so has the test
/// @return what the test returns: skipped (SkippedWithoutDevice) if the solver does not run
template <class Test>
int WithDevice(const Test& test, Claims claims = {})
{
  if (claims.Result() == EXIT_SUCCESS && !HasDevice())
  {
    return SkippedWithoutDevice("LightPropagationMaps gave an error");
  }
  test(claims);
  return claims.Result();
}
}
