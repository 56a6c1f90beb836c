#pragma once

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkExecutive.h"
#include "vtkExtentTranslator.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

/// For filters in parallel pipelines whose light crosses the borders of pieces.
namespace tyndall
{
/// In RequestUpdateExtent: ask the inputs of a port for all of their image, or all pieces of their polydata.
inline void AskForAll(vtkInformationVector* inputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  for (int i = 0; i < inputs->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* information = inputs->GetInformationObject(i);
    if (information->Has(Pipeline::WHOLE_EXTENT()))
    {
      int whole[6];
      information->Get(Pipeline::WHOLE_EXTENT(), whole);
      information->Set(Pipeline::UPDATE_EXTENT(), whole, 6);
    }
    information->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
    information->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
    information->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  }
}

/// In RequestData: the output port that asks.
inline vtkInformation* AskingPort(vtkInformation* request, vtkInformationVector* outputs)
{
  const int port = std::max(request->Get(vtkExecutive::FROM_OUTPUT_PORT()), 0); // -1: no port, but the filter itself
  return outputs->GetInformationObject(port);
}

/// In RequestData: whether the piece that is asked for is the first, the one that has what is not divided. The port
/// that asks says so; other ports may not know their piece yet.
inline bool IsFirstPiece(vtkInformation* request, vtkInformationVector* outputs)
{
  auto* const piece = vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER();
  vtkInformation* const asking = AskingPort(request, outputs);
  return !asking->Has(piece) || asking->Get(piece) <= 0;
}

/// Marks the cells and points of an image that a neighbouring piece has, too (vtkGhostType), so that sums over pieces
/// have them once. Other flags stay, and so do the arrays of the input, which the image may share.
/// @param own  extent of the piece without ghost cells
inline void MarkDuplicates(vtkImageData* image, const int own[6])
{
  const auto mark = [&](vtkDataSetAttributes* of, int fromPoints, unsigned char flag) {
    int extent[6];
    image->GetExtent(extent);
    auto* const before =
      vtkArrayDownCast<vtkUnsignedCharArray>(of->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
    vtkNew<vtkUnsignedCharArray> flags;
    flags->SetName(vtkDataSetAttributes::GhostArrayName());
    vtkIdType number = 0;
    for (int k = extent[4]; k <= extent[5] - fromPoints; ++k)
    {
      for (int j = extent[2]; j <= extent[3] - fromPoints; ++j)
      {
        for (int i = extent[0]; i <= extent[1] - fromPoints; ++i, ++number)
        {
          const bool inside = i >= own[0] && i <= own[1] - fromPoints && j >= own[2] && j <= own[3] - fromPoints &&
            k >= own[4] && k <= own[5] - fromPoints;
          const unsigned char kept = before ? before->GetValue(number) : 0;
          flags->InsertNextValue(inside ? kept : kept | flag);
        }
      }
    }
    of->RemoveArray(vtkDataSetAttributes::GhostArrayName());
    of->AddArray(flags);
  };
  mark(image->GetCellData(), 1, vtkDataSetAttributes::DUPLICATECELL);
  mark(image->GetPointData(), 0, vtkDataSetAttributes::DUPLICATEPOINT);
}

/// In RequestData: crop the output to the extent, or the piece of it, that was asked for; other ranks hold the rest.
inline void KeepWhatIsAskedFor(vtkInformation* information, vtkImageData* output)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  int asked[6];
  int own[6]; // without ghost cells
  bool ghosts = false;
  information->Get(Pipeline::UPDATE_EXTENT(), asked);
  if (information->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) > 1)
  {
    vtkNew<vtkExtentTranslator> translator;
    translator->SetWholeExtent(asked);
    translator->SetPiece(information->Get(Pipeline::UPDATE_PIECE_NUMBER()));
    translator->SetNumberOfPieces(information->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()));
    translator->SetGhostLevel(information->Get(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS()));
    if (!translator->PieceToExtent())
    {
      output->Initialize(); // more ranks than voxels
      return;
    }
    translator->GetExtent(asked);
    translator->SetGhostLevel(0);
    ghosts = information->Get(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS()) > 0 && translator->PieceToExtent();
    translator->GetExtent(own);
  }
  if (asked[0] <= asked[1] && asked[2] <= asked[3] && asked[4] <= asked[5])
  {
    output->Crop(asked);
  }
  if (ghosts)
  {
    MarkDuplicates(output, own);
  }
}

/// In RequestData: the extent of an output that shows only when it is made. The pipeline had to guess it, and would run
/// the filter again for what the guess has beyond it.
/// @param asking  the port that asks: VTK takes it that all ports then have its piece
inline void TellExtent(vtkInformation* asking, vtkInformation* information, const int extent[6])
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  information->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  information->Set(Pipeline::UPDATE_EXTENT(), extent, 6);
  for (vtkInformationIntegerKey* key :
    { Pipeline::UPDATE_PIECE_NUMBER(), Pipeline::UPDATE_NUMBER_OF_PIECES(), Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS() })
  {
    information->CopyEntry(asking, key);
  }
}

/// The same of an image, of which then the piece that was asked for is kept.
inline void TellExtentAndKeepWhatIsAskedFor(vtkInformation* asking, vtkInformation* information, vtkImageData* output)
{
  TellExtent(asking, information, output->GetExtent());
  KeepWhatIsAskedFor(information, output);
}
}
