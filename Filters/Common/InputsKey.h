#pragma once

#include "Common/ArrayTimes.h"
#include "Device/Device.h"
#include "Medium/Grid.h"

#include "vtkAlgorithm.h"
#include "vtkDataArray.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkImageData.h"
#include "vtkUnsignedCharArray.h"

#include <initializer_list>
#include <memory>
#include <vector>

/// For filters that keep what they made of their inputs between updates.
namespace tyndall
{
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

  /// Which cells of an image are hidden (GhostFlags.h).
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
