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
/// Function that returns the data to use for a connection of a port: other data, or `data` itself.
using ChangeOfData = std::function<vtkSmartPointer<vtkDataObject>(int connection, vtkDataObject* data)>;
/// Returns a port's connections with their data changed; null if all data stay the same.
vtkSmartPointer<vtkInformationVector> WithData(vtkInformationVector* given, const ChangeOfData& change);

/// Inputs of a filter, with images transformed to the axes in which the filter works.
///
/// Images that a filter reads as voxels are aligned with the world axes if their axes are a signed permutation of the
/// world axes. If the image at port 0 is rotated by other than right angles, the filter works in the axes of that image
/// (OwnAxes), the same on all ranks.
class AlignedInputs
{
public:
  /// Aligns the inputs of a filter. Collective.
  /// @param ranks  null: this process is alone
  /// @param given  the filter's inputs by port
  /// @throws InvalidInput, the same on all ranks, if pieces of an image have different axes
  AlignedInputs(vtkMultiProcessController* ranks, vtkAlgorithm* filter, vtkInformationVector** given);

  /// Rotates output images from the medium axes (OwnAxes), in which the filter has worked, back to the scene axes.
  void PutIntoScene(vtkInformationVector* outputs);

  std::vector<vtkSmartPointer<vtkInformationVector>> ports;

private:
  void AlignGiven(vtkInformationVector** given);
  void AgreeOnAxes(vtkMultiProcessController* ranks);
  void TurnGiven();
  void NoteAveragedArrays();

  vtkAlgorithm* Filter;
  OwnAxes Axes;                          ///< axes of the image at port 0, in which the filter works
  vtkSmartPointer<vtkDataObject> Medium; ///< image at port 0 before its transformation to Axes; null: none
};
}
