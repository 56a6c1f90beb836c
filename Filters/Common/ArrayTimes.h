#pragma once

#include "vtkAbstractArray.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationUnsignedLongKey.h"
#include "vtkPoints.h"
#include "vtkPointSet.h"

#include <vector>

namespace tyndall
{
/// Of a copy of an array whose vectors were turned into other axes (ImageInput.h): when that array was last changed.
inline vtkInformationUnsignedLongKey* TimeBeforeTurning()
{
  static auto* const key = vtkInformationUnsignedLongKey::MakeKey("TIME_BEFORE_TURNING", "Tyndall");
  return key;
}

/// When an array was last changed, or that of which it is a turned copy.
inline vtkMTimeType TimeOf(vtkAbstractArray* array)
{
  const bool isCopy = array->HasInformation() && array->GetInformation()->Has(TimeBeforeTurning());
  return isCopy ? array->GetInformation()->Get(TimeBeforeTurning()) : array->GetMTime();
}

/// When the arrays and the points of a dataset were last changed: point, cell and field data in their order. Two
/// datasets of the same times hold the same: no two objects have the same time.
inline std::vector<vtkMTimeType> TimesOfArrays(vtkDataObject* data)
{
  std::vector<vtkMTimeType> times;
  for (int kind : { vtkDataObject::POINT, vtkDataObject::CELL, vtkDataObject::FIELD })
  {
    vtkFieldData* arrays = data ? data->GetAttributesAsFieldData(kind) : nullptr;
    for (int i = 0; arrays && i < arrays->GetNumberOfArrays(); ++i)
    {
      times.push_back(arrays->GetAbstractArray(i)->GetMTime());
    }
  }
  auto* const set = vtkPointSet::SafeDownCast(data);
  if (set && set->GetPoints())
  {
    times.push_back(set->GetPoints()->GetMTime());
  }
  return times;
}
}
