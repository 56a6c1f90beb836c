#pragma once

#include "Common/ImageInput.h"

#include "vtkDataObject.h"
#include "vtkInformationVector.h"
#include "vtkSmartPointer.h"

#include <functional>
#include <vector>

class vtkAlgorithm;
class vtkMultiProcessController;

namespace tyndall
{
/// Returns other data for a connection of a port, or the same.
using ChangeOfData = std::function<vtkSmartPointer<vtkDataObject>(int connection, vtkDataObject* data)>;
/// A port's connections with their data changed; null if no data change.
vtkSmartPointer<vtkInformationVector> WithData(vtkInformationVector* given, const ChangeOfData& change);

/// Inputs of a filter, its images in the axes in which it works.
///
/// Images that a filter reads as voxels are aligned with the world axes if their axes are a permutation of these. If
/// the first input is rotated otherwise, the filter works in the axes of that image (OwnAxes), the same on all ranks.
class AlignedInputs
{
public:
  /// Collective.
  /// @param ranks  null: this process is alone
  /// @param given  the filter's inputs by port
  /// @throws InvalidInput, the same on all ranks, if pieces of an image have different axes
  AlignedInputs(vtkMultiProcessController* ranks, vtkAlgorithm* filter, vtkInformationVector** given);

  /// Rotates outputs from the medium axes back to the scene axes.
  void PutIntoScene(vtkInformationVector* outputs);

  std::vector<vtkSmartPointer<vtkInformationVector>> ports;

private:
  void AlignGiven(vtkInformationVector** given);
  void AgreeOnAxes(vtkMultiProcessController* ranks);
  void TurnGiven();
  void NoteAveragedArrays();

  vtkAlgorithm* Filter;
  OwnAxes Axes;                          ///< axes of the first port's image
  vtkSmartPointer<vtkDataObject> Medium; ///< that image in scene axes; null: none
};
}
