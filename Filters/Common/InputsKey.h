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

/// Cache keys for results that filters keep between updates, made of modification times or of content.
namespace tyndall
{
/// Key in the information of a copy of an array whose vectors were rotated (ImageAxes.h): modification time of the
/// original.
inline vtkInformationUnsignedLongKey* TimeBeforeTurning()
{
  static auto* const key = vtkInformationUnsignedLongKey::MakeKey("TIME_BEFORE_TURNING", "Tyndall");
  return key;
}

/// Modification time of an array; for a rotated copy, that of the original array.
inline vtkMTimeType TimeOf(vtkAbstractArray* array)
{
  const bool isCopy = array->HasInformation() && array->GetInformation()->Has(TimeBeforeTurning());
  return isCopy ? array->GetInformation()->Get(TimeBeforeTurning()) : array->GetMTime();
}

/// Modification times of a dataset's points and of its point, cell and field data arrays, in order. VTK never gives two
/// objects the same time, so datasets with equal times hold the same data.
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

/// Hash of everything a dataset holds, byte by byte: position, grid, points, arrays with their names. Unlike
/// modification times, the hash does not change if a filter upstream runs again with the same result. ParaView's
/// readers, for example, read a file twice if one time step is requested in two ways.
/// @param data  may be null, for which the hash is a constant
std::uint64_t ContentKey(vtkDataObject* data);

/// Hash of a dataset as by ContentKey, but without field data arrays. Ranks that hold the same photons may have
/// different field data about the medium if one of them has no piece of it.
std::uint64_t ContentKeyButFacts(vtkDataObject* data);

/// Cache key of a result that a filter computed on a device from its inputs. Equal keys mean that device, arrays and
/// settings are unchanged: VTK never gives two objects the same modification time.
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

  /// Adds the modification times of an image's flags vtkGhostType, which hide cells (ImageInput.h).
  void AddGhosts(vtkImageData* image)
  {
    this->Add(image->GetCellGhostArray());
    this->Add(image->GetPointGhostArray());
  }

  /// Adds the modification time of an array.
  /// @param array  null: no such array
  void Add(vtkDataArray* array) { this->times.push_back(array ? TimeOf(array) : 0); }

  /// Adds the modification times of all arrays of a dataset; null: no dataset.
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

/// Whether filters upstream of an input port have run since `time`, or will run in this update. The modification time
/// of the input data is no substitute: ParaView's internal filters create a new data object, with the same arrays, on
/// every access, and values may change without Modified() of their array.
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
