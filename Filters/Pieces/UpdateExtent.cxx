#include "Pieces/UpdateExtent.h"

#include "Pieces/Ranks.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkExecutive.h"
#include "vtkExtentTranslator.h"
#include "vtkImageData.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationExecutivePortKey.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationIntegerVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <memory>

namespace tyndall
{
std::array<int, 6> ExtentWithoutDuplicates(
  const std::array<int, 6>& extent, vtkUnsignedCharArray* flags, bool flagsPoints)
{
  static_assert(static_cast<int>(vtkDataSetAttributes::DUPLICATECELL) == vtkDataSetAttributes::DUPLICATEPOINT, "");
  std::array<int, 6> own = { extent[1], extent[0], extent[3], extent[2], extent[5], extent[4] };
  const int beyond = flagsPoints ? 0 : 1;
  (flagsPoints ? PointBoxOf(extent) : CellBoxOf(extent)).ForEach([&](vtkIdType index, const std::array<int, 3>& at) {
    for (int axis = 0; axis < 3 && !(flags->GetValue(index) & vtkDataSetAttributes::DUPLICATECELL); ++axis)
    {
      own[2 * axis] = std::min(own[2 * axis], at[axis]);
      own[2 * axis + 1] = std::max(own[2 * axis + 1], std::min(at[axis] + beyond, extent[2 * axis + 1]));
    }
  });
  return own;
}

void FlagDuplicates(vtkDataSetAttributes* attributes, const ValueBox& box, unsigned char flag,
  const std::function<bool(const std::array<int, 3>&)>& isDuplicate)
{
  auto* const before =
    vtkArrayDownCast<vtkUnsignedCharArray>(attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  flags->SetNumberOfTuples(static_cast<vtkIdType>(box.Count()));
  box.ForEach([&](vtkIdType index, const std::array<int, 3>& at) {
    const unsigned char kept = before ? before->GetValue(index) : 0;
    flags->SetValue(index, isDuplicate(at) ? kept | flag : kept);
  });
  attributes->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  attributes->AddArray(flags);
}

void ValueBox::Add(const ValueBox& other)
{
  if (this->IsEmpty())
  {
    *this = other;
    return;
  }
  for (int axis = 0; axis < 3 && !other.IsEmpty(); ++axis)
  {
    this->low[axis] = std::min(this->low[axis], other.low[axis]);
    this->high[axis] = std::max(this->high[axis], other.high[axis]);
  }
}

ValueBox PointBoxOf(const std::array<int, 6>& extent)
{
  return { { extent[0], extent[2], extent[4] }, { extent[1], extent[3], extent[5] } };
}

ValueBox CellBoxOf(const std::array<int, 6>& extent)
{
  ValueBox box = PointBoxOf(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    box.high[axis] = box.high[axis] > box.low[axis] ? box.high[axis] - 1 : box.high[axis];
  }
  return box;
}

namespace
{
using Pipeline = vtkStreamingDemandDrivenPipeline;
using Extent = std::array<int, 6>;

/// Key in an output's information: the number of this rank, then the extent that each rank is asked for
/// (NotePartsOfRanks).
vtkInformationIntegerVectorKey* PartsOfRanks()
{
  static auto* const key = vtkInformationIntegerVectorKey::MakeKey("PARTS_OF_RANKS", "Tyndall");
  return key;
}

/// Key in an output's information: the whole extents that were announced when its data were made (NoteExtentTold).
vtkInformationIntegerVectorKey* ExtentsTold()
{
  static auto* const key = vtkInformationIntegerVectorKey::MakeKey("EXTENTS_TOLD", "Tyndall");
  return key;
}

Extent ExtentOf(vtkImageData* image)
{
  Extent extent;
  image->GetExtent(extent.data());
  return extent;
}

/// Flags the ghost cells of an image's piece, and their points, as duplicates.
/// @param own  extent of the piece without ghost cells
void MarkDuplicates(vtkImageData* image, const Extent& own)
{
  const Extent all = ExtentOf(image);
  FlagDuplicates(image->GetCellData(), CellBoxOf(all), vtkDataSetAttributes::DUPLICATECELL,
    [&](const auto& cell) { return !CellBoxOf(own).Holds(cell); });
  FlagDuplicates(image->GetPointData(), PointBoxOf(all), vtkDataSetAttributes::DUPLICATEPOINT,
    [&](const auto& point) { return !PointBoxOf(own).Holds(point); });
}

/// The extent that a rank is asked for, as recorded by NotePartsOfRanks.
Extent PartOfRank(vtkInformation* information, int rank)
{
  Extent extent;
  std::copy_n(information->Get(PartsOfRanks()) + 1 + 6 * rank, 6, extent.begin());
  return extent;
}

/// Flags cells of this rank's output as duplicates if they are also requested from a rank with a lower number
/// (NotePartsOfRanks).
void MarkThoseBefore(vtkInformation* information, vtkImageData* output)
{
  const int rank = information->Get(PartsOfRanks())[0];
  const int ranks = information->Length(PartsOfRanks()) / 6;
  const auto isBefore = [&](const std::array<int, 3>& cell) {
    bool before = false;
    for (int other = 0; other < std::min(rank, ranks); ++other)
    {
      const Extent part = PartOfRank(information, other);
      before = before || (PointBoxOf(part).Count() > 0 && CellBoxOf(part).Holds(cell));
    }
    return before;
  };
  if (rank > 0)
  {
    FlagDuplicates(output->GetCellData(), CellBoxOf(ExtentOf(output)), vtkDataSetAttributes::DUPLICATECELL, isBefore);
  }
}

/// The part of an output that is requested.
struct Part
{
  bool isOfRank = false; ///< whether the part is one recorded by NotePartsOfRanks
  bool divided = false;
  /// Requested extents. Empty extents mean that nothing is requested if `divided`, and that the complete output is
  /// requested otherwise.
  AskedPiece piece;
};

/// Determines the requested part of an output. A request for an announced whole extent (AsksForAll) means all of
/// `image`, and a request for a piece of that extent means a piece of `image`. The two extents may differ, if another
/// time step was announced, or if the extent was announced before point arrays were known to have one voxel around each
/// point. If `image` does not contain the announced extent, for example because only the piece was made, the piece is
/// that of the requested extent.
/// @param image  the extent of the output as it was made
Part PartAskedFor(vtkInformation* information, const Extent& image)
{
  Part part;
  part.divided = information->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) > 1;
  if (const int* const parts = information->Get(PartsOfRanks()))
  {
    part.isOfRank = part.divided; // if the output is not divided, each rank is asked for all of it
    const Extent own = part.divided ? PartOfRank(information, parts[0]) : AskedPiece::Nothing;
    part.piece = { own, own };
    return part;
  }
  Extent update;
  information->Get(Pipeline::UPDATE_EXTENT(), update.data());
  const bool all = AsksForAll(information) && (!part.divided || Covers(image.data(), update.data()));
  part.piece = AskedPieceOf(information, all ? image : update);
  return part;
}

/// Updates the information of time-dependent inputs to the requested time step. VTK does not pass the new extent of a
/// time series to filters downstream of its source. Not collective.
/// @return whether the extent of an input depends on time
bool HearOfTime(vtkInformationVector* inputs)
{
  bool any = false;
  for (int i = 0; i < inputs->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* const input = inputs->GetInformationObject(i);
    vtkExecutive* const producer = vtkExecutive::PRODUCER()->GetExecutive(input);
    if (producer && input->Has(Pipeline::TIME_DEPENDENT_INFORMATION()))
    {
      const UpdateRequest asked(input);
      producer->UpdateInformation();
      asked.Restore();
      any = true;
    }
  }
  return any;
}

/// Repeats REQUEST_INFORMATION of a filter, so that its outputs get extent, origin and spacing of the first input at
/// the new time step.
void TellAgain(vtkExecutive* own, vtkInformationVector* outputs)
{
  vtkInformation* const first = own->GetInputInformation()[0]->GetInformationObject(0);
  for (int i = 0; i < outputs->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* const output = outputs->GetInformationObject(i);
    output->CopyEntry(first, Pipeline::WHOLE_EXTENT());
    output->CopyEntry(first, vtkDataObject::ORIGIN());
    output->CopyEntry(first, vtkDataObject::SPACING());
  }
  vtkNew<vtkInformation> request;
  request->Set(Pipeline::REQUEST_INFORMATION());
  own->GetAlgorithm()->ProcessRequest(request, own->GetInputInformation(), outputs);
}

/// In RequestUpdateExtent: sets the extent of inputs and outputs for the requested time step. Filters downstream are
/// not informed and may request earlier extents that lie outside of the current one.
void FollowTime(vtkInformationVector* inputs, vtkInformationVector* outputs)
{
  vtkExecutive* const own = vtkExecutive::PRODUCER()->GetExecutive(outputs->GetInformationObject(0));
  if (!HearOfTime(inputs) || !own || inputs != own->GetInputInformation()[0])
  {
    return;
  }
  std::vector<std::unique_ptr<UpdateRequest>> asked;
  for (int i = 0; i < outputs->GetNumberOfInformationObjects(); ++i)
  {
    asked.push_back(std::make_unique<UpdateRequest>(outputs->GetInformationObject(i)));
  }
  TellAgain(own, outputs);
  for (int i = 0; i < outputs->GetNumberOfInformationObjects(); ++i)
  {
    asked[static_cast<std::size_t>(i)]->Restore();
    outputs->GetInformationObject(i)->Set(Pipeline::UNRESTRICTED_UPDATE_EXTENT(), 1);
  }
}
}

UpdateRequest::UpdateRequest(vtkInformation* information)
  : Information(information)
  , All(!information->Has(Pipeline::UPDATE_EXTENT()) || AsksForAll(information))
{
  NoteExtentTold(information); // filters downstream that do not know the new extent will request this one again
  for (vtkInformationKey* key : Keys())
  {
    this->Before->CopyEntry(information, key);
  }
}

void UpdateRequest::Restore() const
{
  vtkInformation* const now = this->Information;
  const int* const whole = now->Get(Pipeline::WHOLE_EXTENT());
  const std::array<vtkInformationKey*, 4> keys = Keys();
  std::for_each(keys.begin(), keys.end() - 1, [&](vtkInformationKey* key) { now->CopyEntry(this->Before, key); });
  const int* const asked = this->Before->Get(Pipeline::UPDATE_EXTENT());
  if (whole && asked)
  {
    Extent extent;
    std::copy_n(!this->All && Covers(whole, asked) ? asked : whole, 6, extent.begin());
    now->Set(Pipeline::UPDATE_EXTENT(), extent.data(), 6);
  }
}

std::array<vtkInformationKey*, 4> UpdateRequest::Keys()
{
  return { Pipeline::UPDATE_PIECE_NUMBER(), Pipeline::UPDATE_NUMBER_OF_PIECES(),
    Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), Pipeline::UPDATE_EXTENT() };
}

void AskForSame(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs)
{
  FollowTime(inputs, outputs);
  AskTogether(request, outputs, inputs);
}

void AskForAll(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs)
{
  FollowTime(inputs, outputs);
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

void AskForPiece(vtkInformation* request, vtkInformationVector* inputs, vtkInformationVector* outputs)
{
  AskForAll(request, inputs, outputs);
  vtkMultiProcessController* const ranks = RanksTogether(request, outputs);
  for (int i = 0; ranks && i < inputs->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* const information = inputs->GetInformationObject(i);
    information->Set(Pipeline::UPDATE_PIECE_NUMBER(), ranks->GetLocalProcessId());
    information->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), ranks->GetNumberOfProcesses());
    information->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 1);
  }
}

void AskForAllBut(int piece, vtkInformation* request, vtkInformationVector** inputs, int ports,
  vtkInformationVector* outputs, const std::vector<int>& besides)
{
  for (int port = 0; port < ports; ++port)
  {
    const bool isBeside = std::find(besides.begin(), besides.end(), port) != besides.end();
    if (port == piece || isBeside)
    {
      AskForSame(request, inputs[port], outputs);
    }
    else
    {
      AskForAll(request, inputs[port], outputs);
    }
  }
}

vtkInformation* AskingPort(vtkInformation* request, vtkInformationVector* outputs)
{
  // Port -1 means that the filter itself made the request.
  const int port = std::max(request->Get(vtkExecutive::FROM_OUTPUT_PORT()), 0);
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
    return AskedPiece::Nothing;
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
    output->Initialize(); // empty piece: there are more ranks than voxels
    return;
  }
  Extent extent = piece.withGhosts;
  output->Crop(extent.data());
  if (piece.own != piece.withGhosts)
  {
    MarkDuplicates(output, piece.own);
  }
}

std::array<int, 6> ExtentAskedFor(vtkInformation* information, const std::array<int, 6>& image)
{
  const Part part = PartAskedFor(information, image);
  if (part.piece.IsEmpty())
  {
    return part.divided ? AskedPiece::Nothing : image;
  }
  Extent extent = image;
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[2 * axis] = std::max(part.piece.withGhosts[2 * axis], image[2 * axis]);
    extent[2 * axis + 1] = std::min(part.piece.withGhosts[2 * axis + 1], image[2 * axis + 1]);
  }
  return extent;
}

bool Covers(const int* extent, const int* other)
{
  bool covers = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    covers = covers && extent[2 * axis] <= other[2 * axis] && extent[2 * axis + 1] >= other[2 * axis + 1];
  }
  return covers;
}

bool AsksForAll(vtkInformation* information)
{
  Extent asked = AskedPiece::Nothing, whole = AskedPiece::Nothing;
  information->Get(Pipeline::UPDATE_EXTENT(), asked.data());
  if (information->Has(Pipeline::WHOLE_EXTENT()))
  {
    information->Get(Pipeline::WHOLE_EXTENT(), whole.data());
  }
  const int* const told = information->Get(ExtentsTold());
  bool all = asked == whole;
  for (int i = 0; i < information->Length(ExtentsTold()); i += 6)
  {
    all = all || std::equal(asked.begin(), asked.end(), told + i);
  }
  return all;
}

void NoteExtentTold(vtkInformation* information)
{
  const int* const whole = information->Get(Pipeline::WHOLE_EXTENT());
  const int* const told = information->Get(ExtentsTold());
  bool isNew = whole != nullptr;
  for (int i = 0; isNew && i < information->Length(ExtentsTold()); i += 6)
  {
    isNew = !std::equal(whole, whole + 6, told + i);
  }
  std::for_each(whole, whole + (isNew ? 6 : 0), [&](int bound) { information->Append(ExtentsTold(), bound); });
}

void KeepWhatIsAskedFor(vtkInformation* information, vtkImageData* output)
{
  KeepWhatIsAskedFor(information, output, ExtentOf(output));
}

void KeepWhatIsAskedFor(vtkInformation* information, vtkImageData* output, const Extent& image)
{
  NoteExtentTold(information);
  const Part part = PartAskedFor(information, image);
  if (!part.divided && part.piece.own == image) // the complete output may be larger than was announced
  {
    information->Set(Pipeline::WHOLE_EXTENT(), image.data(), 6);
    information->Set(Pipeline::UPDATE_EXTENT(), image.data(), 6);
  }
  if (part.divided || !part.piece.IsEmpty())
  {
    KeepPiece(part.piece, output);
  }
  if (part.isOfRank && !part.piece.IsEmpty())
  {
    MarkThoseBefore(information, output);
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
  NotePartsOfRanks(information, {}, 0);
}
}
