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
/// The medium of this rank's subdomain and what lights it, as a solver takes them.
struct SolverScene
{
  /// Reads the medium; what lights it is added later. Collective.
  /// @param given  the filter's medium
  /// @throws InvalidInput  on each rank what ReadMedium throws on one
  SolverScene(const PieceBlocks& pieces, vtkAlgorithm* filter, vtkImageData* given);

  const PieceBlocks& pieces;
  const Domain& domain;
  bool
    decomposed; ///< into pieces, which may be on one rank: by the kernels for blocks, until these are the serial ones

  vtkSmartPointer<vtkImageData> image;      ///< whose arrays the medium has; null if the subdomain is empty
  vtkSmartPointer<vtkImageData> uncollided; ///< the same of UncollidedLight; null: none, or not read
  vtkPolyData* share = nullptr;             ///< points of which this rank has some, of a solver with an input of such
  MediumInput input;
  Medium medium;      ///< empty if the subdomain is
  bool emits = false; ///< the medium, on any rank
  IlluminationInput shining;
};
}
