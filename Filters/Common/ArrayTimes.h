#pragma once

#include "vtkAbstractArray.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkPoints.h"
#include "vtkPointSet.h"

#include <vector>

namespace tyndall
{
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
