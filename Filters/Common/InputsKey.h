#pragma once

#include "Device/Device.h"
#include "Medium/Grid.h"

#include "vtkAbstractArray.h"
#include "vtkAlgorithm.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationUnsignedLongKey.h"
#include "vtkPoints.h"
#include "vtkPointSet.h"
#include "vtkUnsignedCharArray.h"

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <vector>

/// Keys for what filters keep between updates: by times of change, or by content.
namespace tyndall
{
/// In a copy of an array whose vectors were rotated into other axes (ImageAxes.h): when that array was last changed.
inline vtkInformationUnsignedLongKey* TimeBeforeTurning()
{
  static auto* const key = vtkInformationUnsignedLongKey::MakeKey("TIME_BEFORE_TURNING", "Tyndall");
  return key;
}

/// When an array was last changed, or the one of which it is a rotated copy.
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

/// A number that two datasets have in common only if all that they hold is the same, byte by byte: place, grid, points,
/// arrays with their names. Unlike times it does not change where a filter before ran again and made the same, as
/// ParaView's readers do, which read a file twice for two ways to ask for one time step.
/// @param data  null: that there is none
std::uint64_t ContentKey(vtkDataObject* data);

/// The same without the arrays of the field data: ranks that hold the same photons know other facts of the medium where
/// one has no piece of it.
std::uint64_t ContentKeyButFacts(vtkDataObject* data);

/// Tells whether what was made on a device of a filter's inputs is still up to date: keys are equal as long as nothing
/// has changed. No two objects of VTK have the same time.
struct InputsKey
{
  std::shared_ptr<Device> device;
  std::vector<vtkMTimeType> times;
  std::vector<double> numbers;

  void Add(std::initializer_list<double> more) { this->numbers.insert(this->numbers.end(), more); }

  void Add(const Grid& grid)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Add({ static_cast<double>(grid.size[axis]), grid.spacing[axis], grid.origin[axis] });
    }
  }

  /// Which cells of an image are hidden (ImageInput.h).
  void AddGhosts(vtkImageData* image)
  {
    this->Add(image->GetCellGhostArray());
    this->Add(image->GetPointGhostArray());
  }

  /// @param array  null: that there is none
  void Add(vtkDataArray* array) { this->times.push_back(array ? TimeOf(array) : 0); }

  /// All arrays of a dataset; null: that there is none.
  void Add(vtkDataObject* data)
  {
    const std::vector<vtkMTimeType> ofArrays = TimesOfArrays(data);
    this->times.push_back(ofArrays.size());
    this->times.insert(this->times.end(), ofArrays.begin(), ofArrays.end());
  }

  bool operator==(const InputsKey& other) const
  {
    return this->device == other.device && this->times == other.times && this->numbers == other.numbers;
  }
};

/// Whether filters before an input port will run again, or have, since a time. Their data do not tell: ParaView's
/// filters between filters make them anew, with the same arrays, whenever they are looked at; and values may be changed
/// without telling their array.
inline bool RanSince(vtkAlgorithm* filter, int port, vtkMTimeType time)
{
  bool ran = false;
  for (int i = 0; !ran && i < filter->GetNumberOfInputConnections(port); ++i)
  {
    auto* const before = vtkDemandDrivenPipeline::SafeDownCast(filter->GetInputExecutive(port, i));
    ran = !before || before->GetPipelineMTime() > time;
  }
  return ran;
}
}
