#pragma once

#include "Common/LightTransportData.h"
#include "Distribution/Domain.h"
#include "Medium/Medium.h"
#include "Pieces/PieceBlocks.h"

#include "vtkSmartPointer.h"

class vtkAlgorithm;
class vtkImageData;
class vtkPolyData;

namespace tyndall
{
/// Input of a solver: the medium of this rank's subdomain and its light sources.
struct SolverScene
{
  /// Reads the medium; the caller adds the light sources later. Collective.
  /// @param given  the filter's input image, on this rank
  /// @throws InvalidInput, the same on all ranks, if ReadMedium throws on any
  SolverScene(const PieceBlocks& pieces, vtkAlgorithm* filter, vtkImageData* given);

  const PieceBlocks& pieces;
  const Domain& domain;

  vtkSmartPointer<vtkImageData> image;      ///< owns the arrays that `medium` points to; null if the subdomain is empty
  vtkSmartPointer<vtkImageData> uncollided; ///< owns UncollidedLight's arrays; null if that is not read
  vtkPolyData* share = nullptr;             ///< this rank's points (photons), if the solver has such an input
  MediumInput input;
  Medium medium;      ///< empty if the subdomain is empty
  bool emits = false; ///< whether the medium emits on any rank
  IlluminationInput shining;
};
}
