#pragma once

#include "MediumScene.h"

#include "vtkFieldData.h"
#include "vtkLightRig.h"
#include "vtkPhotonEmitter.h"
#include "vtkPhotonImportance.h"
#include "vtkPhotonMarcher.h"
#include "vtkPhotonReconstruction.h"
#include "vtkPolyData.h"

#include <cmath>
#include <initializer_list>
#include <string>

/// Adaptive photons for the tests of filters.
namespace test
{
/// A ball of glass in fog.
inline vtkSmartPointer<vtkImageData> GlassBall(int cells = 32)
{
  auto medium = MakeMedium({ { cells, cells, cells } }, 0.0, 0.3 / cells);
  AddValues<vtkDoubleArray>(medium->GetCellData(), "ior", medium->GetNumberOfCells(), 1, [=](vtkIdType i, int) {
    const double half = 0.5 * (cells - 1);
    const double r = std::hypot(i % cells - half, i / cells % cells - half, i / (cells * cells) - half);
    return 1.0 + 0.25 * std::erfc((r - 0.3 * cells) / 2.0);
  });
  return medium;
}

/// A sun from above, the map of where its photons are needed, the photons, what they leave, and that without noise.
struct Adaptive
{
  vtkNew<vtkLightRig> rig;
  vtkNew<vtkPhotonImportance> importance;
  vtkNew<vtkPhotonEmitter> emitter;
  vtkNew<vtkPhotonMarcher> marcher;
  vtkNew<vtkPhotonReconstruction> reconstruction;

  explicit Adaptive(vtkImageData* medium)
  {
    this->rig->SetSunElevation(90.0);
    this->SetMedium(medium);
    this->importance->SetLightsConnection(this->rig->GetOutputPort());
    this->emitter->SetLightsConnection(this->rig->GetOutputPort());
    this->emitter->SetImportanceMapConnection(this->importance->GetOutputPort());
    this->emitter->SetPhotonCount(20000);
    this->marcher->SetPhotonsConnection(this->emitter->GetOutputPort());
    this->reconstruction->SetInputConnection(this->marcher->GetOutputPort());
  }

  void SetMedium(vtkImageData* medium)
  {
    this->importance->SetInputDataObject(medium);
    this->emitter->SetInputDataObject(medium);
    this->marcher->SetInputDataObject(medium);
  }

  vtkImageData* Map() { return this->importance->GetOutput(); }
  vtkImageData* Pilot() { return vtkImageData::SafeDownCast(this->importance->GetOutputDataObject(1)); }
  vtkPolyData* Photons() { return this->emitter->GetOutput(); }
  vtkImageData* Noisy() { return vtkImageData::SafeDownCast(this->marcher->GetOutputDataObject(0)); }
  vtkImageData* Smooth() { return this->reconstruction->GetOutput(); }
};

/// A cell array of so many components, one value each for every cell, all finite; null, and a failed claim, where it is
/// not.
inline vtkDataArray* FiniteCells(Claims& claims, vtkImageData* image, const char* name, int components)
{
  vtkDataArray* array = image->GetCellData()->GetArray(name);
  const bool there = array && array->GetNumberOfComponents() == components && image->GetNumberOfCells() > 0 &&
    array->GetNumberOfTuples() == image->GetNumberOfCells();
  if (!claims.That(there, std::string("cells ") + name + " of " + std::to_string(components) + " components are there"))
  {
    return nullptr;
  }
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    const double value = array->GetComponent(i / components, static_cast<int>(i % components));
    if (!std::isfinite(value))
    {
      claims.That(false, std::string(name) + " is finite everywhere");
      return nullptr;
    }
  }
  return array;
}

/// The sum of an array's component.
inline double Total(vtkDataArray* array, int component = 0)
{
  double sum = 0.0;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    sum += array->GetComponent(i, component);
  }
  return sum;
}

inline double TotalCells(vtkImageData* image, const char* name)
{
  return Total(image->GetCellData()->GetArray(name));
}

/// A number of the field data; NaN where there is none.
inline double Fact(vtkDataObject* data, const char* name, int i = 0)
{
  vtkDataArray* fact = data->GetFieldData()->GetArray(name);
  return fact && fact->GetNumberOfTuples() > i ? fact->GetComponent(i, 0) : std::nan("");
}

/// Whether all outputs of filters are empty.
inline bool AreEmpty(std::initializer_list<vtkAlgorithm*> filters)
{
  bool empty = true;
  for (vtkAlgorithm* filter : filters)
  {
    for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
    {
      empty = empty && filter->GetOutputDataObject(port)->GetNumberOfElements(vtkDataObject::CELL) == 0;
    }
  }
  return empty;
}
}
