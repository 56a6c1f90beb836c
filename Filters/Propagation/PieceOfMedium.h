#pragma once

#include "Common/LightTransportData.h"
#include "Distribution/Communicator.h"
#include "Medium/Medium.h"

#include "vtkSmartPointer.h"

class vtkAlgorithm;
class vtkImageData;
class vtkPolyData;

namespace tyndall
{
class PieceBlocks;

/// The medium of a rank's block.
struct PieceOfMedium
{
  /// All ranks make one together.
  /// @throws InvalidInput on each what ReadMedium says on one
  PieceOfMedium(Communicator& communicator, const PieceBlocks& pieces, vtkAlgorithm* filter, vtkImageData* given);

  vtkSmartPointer<vtkImageData> image;      ///< whose arrays the medium has; null where the block is empty
  vtkSmartPointer<vtkImageData> uncollided; ///< the same of the light of another filter; null: none, or not read
  vtkPolyData* share = nullptr; ///< points of which this rank has some, where the solver has an input of such
  MediumInput input;
  Medium medium;      ///< empty where the block is
  bool emits = false; ///< the medium of any rank
};
}
