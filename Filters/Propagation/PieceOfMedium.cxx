#include "Propagation/PieceOfMedium.h"

#include "Distribution/SharedMedium.h"
#include "Pieces/PieceBlocks.h"

#include "vtkImageData.h"

namespace tyndall
{
PieceOfMedium::PieceOfMedium(
  Communicator& communicator, const PieceBlocks& pieces, vtkAlgorithm* filter, vtkImageData* given)
{
  communicator.Collective([&] {
    if (pieces.HasOwn())
    {
      this->image = pieces.OwnImage(given);
      this->input = ReadMedium(filter, this->image);
    }
  });
  AgreeOnMeanCosine(communicator, pieces.HasOwn(), this->input.g, this->input.medium);
  this->medium = this->input.medium;
  this->emits = OnAnyRank(communicator, pieces.HasOwn() && this->input.Emits());
}
}
