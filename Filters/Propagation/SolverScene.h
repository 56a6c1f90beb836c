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
  /// Reads the medium of this rank's subdomain; the caller sets the light sources (`shining`) afterwards. Collective.
  /// @param given  the filter's input image on this rank, ghost cells included
  /// @throws InvalidInput, the same on all ranks, if ReadMedium throws on any
  SolverScene(const PieceBlocks& pieces, vtkAlgorithm* filter, vtkImageData* given);

  const PieceBlocks& pieces;
  const Domain& domain;

  vtkSmartPointer<vtkImageData> image;      ///< owns the arrays that `medium` points to; null if the subdomain is empty
  vtkSmartPointer<vtkImageData> uncollided; ///< owns the arrays of UncollidedLight; null without that input
  vtkPolyData* share = nullptr;             ///< this rank's share of the photons; null without such an input
  MediumInput input;
  Medium medium;      ///< medium of the subdomain; empty if the subdomain has no voxels
  bool emits = false; ///< whether the medium emits on any rank
  IlluminationInput shining;
};
}
