#include "Ranks/WholeImage.h"

#include "Ranks/PieceLayout.h"
#include "Ranks/Ranks.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkExecutive.h"
#include "vtkExtentTranslator.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationIntegerVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <functional>

namespace tyndall
{
namespace
{
using Pipeline = vtkStreamingDemandDrivenPipeline;
using Extent = std::array<int, 6>;

/// Of an output: number of this rank, then an extent for each.
vtkInformationIntegerVectorKey* PartsOfRanks()
{
  static auto* const key = vtkInformationIntegerVectorKey::MakeKey("PARTS_OF_RANKS", "Tyndall");
  return key;
}

/// Flags values that a neighbouring piece has, too. Other flags stay, and so do the arrays of the input, which the
/// image may share.
/// @param box  numbers of the values
void Mark(vtkDataSetAttributes* of, const ValueBox& box, unsigned char flag,
  const std::function<bool(const std::array<int, 3>&)>& isDuplicate)
{
  auto* const before =
    vtkArrayDownCast<vtkUnsignedCharArray>(of->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  vtkIdType number = 0;
  std::array<int, 3> at;
  for (at[2] = box.low[2]; at[2] <= box.high[2]; ++at[2])
  {
    for (at[1] = box.low[1]; at[1] <= box.high[1]; ++at[1])
    {
      for (at[0] = box.low[0]; at[0] <= box.high[0]; ++at[0], ++number)
      {
        const unsigned char kept = before ? before->GetValue(number) : 0;
        flags->InsertNextValue(isDuplicate(at) ? kept | flag : kept);
      }
    }
  }
  of->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  of->AddArray(flags);
}

bool IsIn(const ValueBox& box, const std::array<int, 3>& at)
{
  bool in = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    in = in && at[axis] >= box.low[axis] && at[axis] <= box.high[axis];
  }
  return in;
}

Extent ExtentOf(vtkImageData* image)
{
  Extent extent;
  image->GetExtent(extent.data());
  return extent;
}

/// @param own  extent of the piece without ghost cells
void MarkDuplicates(vtkImageData* image, const Extent& own)
{
  const Extent all = ExtentOf(image);
  Mark(image->GetCellData(), CellBoxOf(all), vtkDataSetAttributes::DUPLICATECELL,
    [&](const auto& cell) { return !IsIn(CellBoxOf(own), cell); });
  Mark(image->GetPointData(), PointBoxOf(all), vtkDataSetAttributes::DUPLICATEPOINT,
    [&](const auto& point) { return !IsIn(PointBoxOf(own), point); });
}

/// The part of this rank. Cells that ranks before it are asked for, too, are their duplicates.
void KeepPart(const int* parts, int ranks, vtkImageData* output)
{
  const auto partOf = [parts](int rank) {
    Extent extent;
    std::copy_n(parts + 1 + 6 * rank, 6, extent.begin());
    return extent;
  };
  const int rank = parts[0];
  Extent own = partOf(rank);
  if (PointBoxOf(own).Count() == 0)
  {
    output->Initialize();
    return;
  }
  output->Crop(own.data());
  own = ExtentOf(output);
  const auto isBefore = [&](const std::array<int, 3>& cell) {
    bool before = false;
    for (int other = 0; other < std::min(rank, ranks); ++other)
    {
      before = before || (PointBoxOf(partOf(other)).Count() > 0 && IsIn(CellBoxOf(partOf(other)), cell));
    }
    return before;
  };
  if (rank > 0)
  {
    Mark(output->GetCellData(), CellBoxOf(own), vtkDataSetAttributes::DUPLICATECELL, isBefore);
  }
}
}

void AskForAll(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs)
{
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
  AskTogether(request, outputs, inputs);
}

void AskForAllBut(
  int piece, vtkInformation* request, vtkInformationVector** inputs, int ports, vtkInformationVector* outputs)
{
  for (int port = 0; port < ports; ++port)
  {
    if (port == piece) // the pipeline has asked it for what the output is asked for
    {
      AskTogether(request, outputs, inputs[port]);
    }
    else
    {
      AskForAll(request, inputs[port], outputs);
    }
  }
}

vtkInformation* AskingPort(vtkInformation* request, vtkInformationVector* outputs)
{
  const int port = std::max(request->Get(vtkExecutive::FROM_OUTPUT_PORT()), 0); // -1: no port, but the filter itself
  return outputs->GetInformationObject(port);
}

bool IsFirstPiece(vtkInformation* request, vtkInformationVector* outputs)
{
  vtkInformation* const asking = AskingPort(request, outputs);
  return !asking->Has(Pipeline::UPDATE_PIECE_NUMBER()) || asking->Get(Pipeline::UPDATE_PIECE_NUMBER()) <= 0;
}

void NotePartsOfRanks(vtkInformation* information, const std::vector<std::array<int, 6>>& parts, int rank)
{
  information->Remove(PartsOfRanks());
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    if (i == 0)
    {
      information->Append(PartsOfRanks(), rank);
    }
    std::for_each(parts[i].begin(), parts[i].end(), [&](int bound) { information->Append(PartsOfRanks(), bound); });
  }
}

Extent PartOfExtent(const Extent& whole, int piece, int pieces, int ghostLevels)
{
  Extent part = whole;
  vtkNew<vtkExtentTranslator> translator;
  translator->SetWholeExtent(part.data());
  translator->SetPiece(piece);
  translator->SetNumberOfPieces(pieces);
  translator->SetGhostLevel(ghostLevels);
  if (!translator->PieceToExtent())
  {
    return AskedPiece().own;
  }
  translator->GetExtent(part.data());
  return part;
}

AskedPiece AskedPieceOf(vtkInformation* information, const Extent& whole)
{
  const int pieces = information->Get(Pipeline::UPDATE_NUMBER_OF_PIECES());
  if (pieces <= 1)
  {
    return { whole, whole };
  }
  const int piece = information->Get(Pipeline::UPDATE_PIECE_NUMBER());
  return { PartOfExtent(whole, piece, pieces, information->Get(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS())),
    PartOfExtent(whole, piece, pieces) };
}

void KeepPiece(const AskedPiece& piece, vtkImageData* output)
{
  if (piece.IsEmpty())
  {
    output->Initialize(); // more ranks than voxels
    return;
  }
  output->Crop(piece.withGhosts.data());
  if (piece.own != piece.withGhosts)
  {
    MarkDuplicates(output, piece.own);
  }
}

void KeepWhatIsAskedFor(vtkInformation* information, vtkImageData* output)
{
  const bool divided = information->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) > 1;
  if (const int* const parts = information->Get(PartsOfRanks()))
  {
    if (divided) // else each rank is asked for all
    {
      KeepPart(parts, information->Length(PartsOfRanks()) / 6, output);
    }
    return;
  }
  Extent extent;
  information->Get(Pipeline::UPDATE_EXTENT(), extent.data());
  const AskedPiece asked = AskedPieceOf(information, extent);
  if (divided || PointBoxOf(extent).Count() > 0)
  {
    KeepPiece(asked, output);
  }
}

void TellExtent(vtkInformation* asking, vtkInformation* information, const int extent[6])
{
  information->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  information->Set(Pipeline::UPDATE_EXTENT(), extent, 6);
  for (vtkInformationIntegerKey* key :
    { Pipeline::UPDATE_PIECE_NUMBER(), Pipeline::UPDATE_NUMBER_OF_PIECES(), Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS() })
  {
    information->CopyEntry(asking, key);
  }
}

void TellExtentAndKeepWhatIsAskedFor(vtkInformation* asking, vtkInformation* information, vtkImageData* output)
{
  TellExtent(asking, information, output->GetExtent());
  NotePartsOfRanks(information, {}, 0);
  KeepWhatIsAskedFor(information, output);
}
}
