#include "vtkScatteringSolver.h"

#include "Common/Failure.h"
#include "Common/LightTransportData.h"
#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"
#include "Lights/Lights.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/PieceBlocks.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"
#include "Propagation/LastOutputs.h"
#include "Propagation/PieceOfMedium.h"
#include "Viewing/LitColor.h"

#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace
{
/// Light beside the arrays of the medium, and its convergence.
/// @param ignored  of the medium
/// @param pieces   of which the light is this rank's; null: it is the whole
/// @return its doubts
std::vector<std::string> Write(vtkAlgorithm* filter, tyndall::LightField&& light,
  const std::vector<std::string>& ignored, vtkImageData* medium, vtkInformationVector* outputs,
  const tyndall::PieceBlocks* pieces)
{
  std::vector<std::string> doubts = light.doubts;
  if (!ignored.empty())
  {
    doubts.push_back(tyndall::WarningOf(ignored));
  }
  tyndall::WriteConvergence(light.convergence, light.sweepsSaved, vtkTable::GetData(outputs, 1));
  vtkImageData* const output = vtkImageData::GetData(outputs, 0);
  tyndall::PassOn(medium, output);
  if (pieces)
  {
    pieces->KeepHeld(output);
  }
  if (!pieces || pieces->Held().VoxelCount() > 0)
  {
    tyndall::WriteLight(std::move(light), output); // light that is not finite is an error, with no warnings before
    tyndall::NoteChoices(filter, tyndall::QuantitiesOfMedium(), medium, output);
    if (!ignored.empty())
    {
      tyndall::AddFact(output, tyndall::IgnoredFact, ignored);
    }
  }
  return doubts;
}
}

vtkScatteringSolver::vtkScatteringSolver()
  : Solved(std::make_unique<tyndall::LastOutputs>())
{
  this->SetNumberOfInputPorts(UNCOLLIDED + 1);
  this->SetNumberOfOutputPorts(2);
}

vtkScatteringSolver::~vtkScatteringSolver() = default;

void vtkScatteringSolver::SetUncollidedLightConnection(vtkAlgorithmOutput* light)
{
  this->SetInputConnection(UNCOLLIDED, light);
}

void vtkScatteringSolver::SetUncollidedLightData(vtkDataObject* light)
{
  this->SetInputDataObject(UNCOLLIDED, light);
}

void vtkScatteringSolver::RemoveUncollidedLight()
{
  this->SetInputConnection(UNCOLLIDED, nullptr);
}

int vtkScatteringSolver::FillOutputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

tyndall::IlluminationInput vtkScatteringSolver::ReadAtQuality(vtkInformationVector** inputs, bool emits)
{
  tyndall::IlluminationInput input = this->ReadAllIllumination(inputs, emits);
  if (this->ReadsQuality())
  {
    tyndall::SetFineness(input.illumination.lights, static_cast<tyndall::Quality>(this->Quality));
  }
  return input;
}

tyndall::IlluminationInput vtkScatteringSolver::ReadShining(vtkInformationVector** inputs, bool emits)
{
  vtkImageData* const given = vtkImageData::GetData(inputs[UNCOLLIDED]);
  if (!given)
  {
    return this->ReadAtQuality(inputs, emits);
  }
  tyndall::IlluminationInput input;
  input.uncollided = tyndall::ReadUncollided(given, tyndall::GridOf(vtkImageData::GetData(inputs[MEDIUM])));
  input.illumination.uncollided = input.uncollided.image;
  tyndall::AddFaceAlbedo(input.illumination, this->FaceAlbedo, this->FaceAlbedoColor);
  return input;
}

/// The same of this rank's piece.
tyndall::IlluminationInput vtkScatteringSolver::ReadShiningOn(
  const tyndall::PieceBlocks& pieces, tyndall::PieceOfMedium& piece, vtkInformationVector** inputs)
{
  vtkImageData* const given = vtkImageData::GetData(inputs[UNCOLLIDED]);
  if (inputs[UNCOLLIDED]->GetNumberOfInformationObjects() == 0)
  {
    return this->ReadAtQuality(inputs, piece.emits);
  }
  tyndall::IlluminationInput input;
  if (piece.image)
  {
    piece.uncollided = pieces.OwnImage(given);
    input.uncollided = tyndall::ReadUncollided(piece.uncollided, tyndall::GridOf(piece.image));
    input.illumination.uncollided = input.uncollided.image;
  }
  tyndall::AddFaceAlbedo(input.illumination, this->FaceAlbedo, this->FaceAlbedoColor);
  return input;
}

void vtkScatteringSolver::ColorsModified()
{
  this->ColorsTime.Modified();
  this->InvokeEvent(vtkCommand::ModifiedEvent);
}

void vtkScatteringSolver::SetLitColor(bool make)
{
  if (this->LitColor != make)
  {
    this->LitColor = make;
    this->ColorsModified();
  }
}

void vtkScatteringSolver::SetExposure(double exposure)
{
  if (tyndall::SetInRange<double>(this, "Exposure", &this->Exposure, { exposure }, 0.0, 1e30))
  {
    this->ColorsModified();
  }
}

void vtkScatteringSolver::SetToneCurve(int curve)
{
  if (tyndall::SetInRange<int>(this, "ToneCurve", &this->ToneCurve, { curve }, 0.0, 1.0))
  {
    this->ColorsModified();
  }
}

vtkMTimeType vtkScatteringSolver::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->ColorsTime.GetMTime());
}

int vtkScatteringSolver::UpdateCachedOrSolve(vtkInformation* request, vtkInformationVector** given,
  vtkInformationVector* outputs, const std::function<void(vtkInformationVector** inputs)>& solve)
{
  this->WholeFor.clear();
  tyndall::WorkOnPieces onPieces = { MEDIUM, [&](vtkMultiProcessController* ranks, vtkInformationVector** inputs) {
                                      this->OverRanks = ranks != nullptr;
                                      this->IsFirstRank = !ranks || ranks->GetLocalProcessId() == 0;
                                      return this->GiveOrSolvePiece(request, ranks, inputs, outputs);
                                    } };
  onPieces.shares = this->PortOfShares();
  onPieces.others = { UNCOLLIDED };
  const int done = tyndall::Guarded(this, request, given, outputs, onPieces, [&](vtkInformationVector** inputs) {
    if (std::exchange(this->SolvedInPieces, false))
    {
      this->Solved->Forget();
    }
    if (this->Solved->GiveBack(
          this->Superclass::GetMTime(), tyndall::OwnAxesOf(this), inputs, this->GetNumberOfInputPorts(), outputs))
    {
      this->CropToRequest(inputs, outputs);
      return;
    }
    this->Note({});
    this->Ignored = tyndall::IgnoredIndex(this->IgnoresIndexOf(vtkImageData::GetData(inputs[MEDIUM])));
    solve(inputs);
  });
  if (tyndall::AreEmptied(outputs))
  {
    this->GiveLightBefore(outputs);
  }
  return done;
}

/// After a solve that failed, or was stopped: nothing, or the light of before, which stays in views.
void vtkScatteringSolver::GiveLightBefore(vtkInformationVector* outputs)
{
  tyndall::LightField nothing;
  vtkImageData* const output = vtkImageData::GetData(outputs, 0);
  tyndall::OwnAxes axes;
  if (output->GetFieldData()->HasArray(tyndall::AbortedFact) && this->Solved->GiveBefore(outputs, axes))
  {
    nothing.leftOut = { tyndall::LightOfBefore };
    if (!this->SolvedInPieces)
    {
      tyndall::KeepWhatIsAskedFor(outputs->GetInformationObject(0), output);
    }
    tyndall::PutIntoScene(output, axes, nullptr);
  }
  this->Note(nothing);
}

/// Without WHOLE, whether this rank would have each solve its piece; ranks may differ in it.
bool vtkScatteringSolver::WantsBlocks(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) const
{
  return this->Decomposition == AUTOMATIC_DECOMPOSITION ? tyndall::EachAsksForItsPiece(request, outputs) &&
      tyndall::IsWorthPieces(inputs[MEDIUM]) && this->NotByBlocks(inputs).empty()
                                                        : this->Decomposition == BLOCKS;
}

int vtkScatteringSolver::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bool asPiece = tyndall::EachAsksForItsPiece(request, outputs) && this->WantsBlocks(request, inputs, outputs);
  const std::vector<int> besides = asPiece ? std::vector<int>{ UNCOLLIDED, this->PortOfShares() } : std::vector<int>();
  tyndall::AskForAllBut(asPiece ? MEDIUM : -1, request, inputs, this->GetNumberOfInputPorts(), outputs, besides);
  return 1;
}

std::string vtkScatteringSolver::NotByBlocks(vtkInformationVector**) const
{
  return {};
}

/// @param medium  may be null or without voxels
bool vtkScatteringSolver::IgnoresIndexOf(vtkImageData* medium)
{
  return !this->KnowsIndex() && medium && medium->GetNumberOfCells() > 0 &&
    tyndall::IsUnusual(this, tyndall::RefractiveIndex, medium, "ior", 1.0f);
}

std::string vtkScatteringSolver::NotInBlocks(const tyndall::PieceOfMedium&, const tyndall::IlluminationInput&)
{
  return {};
}

/// What keeps this rank from solving its piece, in words; empty: nothing, and what shines on it is read.
std::string vtkScatteringSolver::NotOnPiece(const tyndall::PieceBlocks& pieces, tyndall::PieceOfMedium& piece,
  tyndall::IlluminationInput& shining, vtkInformationVector** inputs)
{
  std::string refused = this->NotByBlocks(inputs);
  vtkImageData* const given = vtkImageData::GetData(inputs[UNCOLLIDED]);
  if (refused.empty() && given && !pieces.HasOwnOf(given))
  {
    refused = "UncollidedLight in other pieces than the medium";
  }
  if (refused.empty())
  {
    shining = this->ReadShiningOn(pieces, piece, inputs);
    refused = this->NotInBlocks(piece, shining);
  }
  return refused;
}

std::string vtkScatteringSolver::ReasonNotToDecompose(
  tyndall::Communicator&, const tyndall::PieceBlocks&, const tyndall::PieceOfMedium&, const tyndall::IlluminationInput&)
{
  return {};
}

/// @return false, on all ranks, where each is to solve the whole
bool vtkScatteringSolver::GiveOrSolvePiece(vtkInformation* request, vtkMultiProcessController* ranks,
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkImageData* const image = vtkImageData::GetData(inputs[MEDIUM]);
  const std::optional<tyndall::AgreedBlocks> agreed = tyndall::AgreeOnBlocks(
    ranks, this, this->WantsBlocks(request, inputs, outputs), tyndall::AskingPort(request, outputs), image);
  if (!agreed)
  {
    const bool asked = this->Decomposition == AUTOMATIC_DECOMPOSITION && tyndall::EachAsksForItsPiece(request, outputs);
    std::string refused = this->NotByBlocks(inputs);
    if (refused.empty())
    {
      refused =
        tyndall::IsWorthPieces(inputs[MEDIUM]) ? "pieces that are not parts of one grid" : "a medium of few voxels";
    }
    this->WholeFor = asked ? refused : "";
    return false;
  }
  tyndall::Communicator& communicator = *agreed->communicator;
  const tyndall::PieceBlocks& pieces = *agreed->pieces;
  if (this->GivePiece(communicator, pieces, inputs, outputs))
  {
    this->ColorPiece(communicator, pieces, inputs, outputs);
    return true;
  }
  tyndall::PieceOfMedium piece(communicator, pieces, this, image);
  piece.share = this->PortOfShares() < 0 ? nullptr : vtkPolyData::GetData(inputs[this->PortOfShares()]);
  tyndall::IlluminationInput shining;
  std::string refused;
  bool ignoresIndex = false;
  communicator.Collective([&] {
    ignoresIndex = this->IgnoresIndexOf(piece.image);
    refused = this->NotOnPiece(pieces, piece, shining, inputs);
    tyndall::Require(refused.empty() || this->Decomposition != BLOCKS,
      "Ranks cannot solve their pieces (Decomposition: blocks) with " + refused +
        ". Leave it out, or let each rank solve the whole.");
  });
  this->Ignored = tyndall::IgnoredIndex(tyndall::OnAnyRank(communicator, ignoresIndex));
  this->WholeFor = tyndall::WordsOfAny(communicator, refused);
  tyndall::RequireSame(communicator, "Preview", true, { this->Preview ? 1.0 : 0.0 });
  const bool chooses = !this->Preview && !tyndall::OnAnyRank(communicator, this->Decomposition == BLOCKS);
  if (this->WholeFor.empty() && chooses)
  {
    this->WholeFor = this->ReasonNotToDecompose(communicator, pieces, piece, shining);
  }
  if (!this->WholeFor.empty())
  {
    return false;
  }
  this->Note({});
  if (!piece.share)
  {
    this->WarnWhereDark(shining.illumination, piece.emits);
  }
  tyndall::LightField light = this->SolvePiece(communicator, pieces, piece, shining);
  TellOfDefaultSky(shining, light.leftOut);
  this->TellOfPieces(light, true);
  this->Note(light);
  this->WritePiece(communicator, pieces, std::move(light), inputs, outputs);
  this->ColorPiece(communicator, pieces, inputs, outputs);
  return true;
}

/// The last light of this rank's block, where on no rank anything has changed. All ranks call it.
/// @return whether the outputs are there
bool vtkScatteringSolver::GivePiece(tyndall::Communicator& communicator, const tyndall::PieceBlocks& pieces,
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bool kept = this->SolvedInPieces &&
    this->Solved->GiveBack(
      this->Superclass::GetMTime(), tyndall::OwnAxesOf(this), inputs, this->GetNumberOfInputPorts(), outputs);
  const vtkIdType cells = vtkImageData::GetData(outputs, 0)->GetNumberOfCells();
  const bool same = kept && cells == static_cast<vtkIdType>(pieces.Held().VoxelCount());
  const bool onAll = communicator.Largest({ same ? 0.0 : 1.0 })[0] == 0.0;
  if (kept && !onAll)
  {
    this->Solved->LetGo();
  }
  return onAll;
}

/// That over several ranks, and why each solved the whole, where they were to choose.
void vtkScatteringSolver::TellOfPieces(tyndall::LightField& light, bool inBlocks)
{
  if (this->OverRanks || inBlocks)
  {
    light.settingsUsed.push_back("Decomposition = " + std::to_string(inBlocks ? BLOCKS : WHOLE));
  }
  tyndall::AddAveraged(this, light.settingsUsed);
  if (this->OverRanks && !this->WholeFor.empty())
  {
    light.leftOut.push_back("pieces: each rank solved the whole, for " + this->WholeFor);
  }
}

/// WriteSolved of the light of this rank's block. All ranks call it.
void vtkScatteringSolver::WritePiece(tyndall::Communicator& communicator, const tyndall::PieceBlocks& pieces,
  tyndall::LightField&& light, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  pieces.SpreadToHeld(communicator, light.fluence, light.channels);
  pieces.SpreadToHeld(communicator, light.fluenceDirect, light.channels);
  pieces.SpreadToHeld(communicator, light.fluenceError, light.channels);
  pieces.SpreadToHeld(communicator, light.netFlux, 3 * light.channels);
  const int stored = std::max(static_cast<int>(light.storedDirections.size()), 1);
  pieces.SpreadToHeld(communicator, light.scatteredRadiance, light.channels * stored);
  const std::size_t voxels = std::max<std::size_t>(pieces.Own().VoxelCount(), 1);
  const std::vector<double> ofMoments =
    communicator.Largest({ 1.0 * static_cast<double>(light.scatteredMoments.size() / voxels),
      1.0 * static_cast<double>(light.straightOn.size() / voxels) }); // a rank without voxels does not know
  pieces.SpreadToHeld(communicator, light.scatteredMoments, static_cast<int>(ofMoments[0]));
  pieces.SpreadToHeld(communicator, light.straightOn, static_cast<int>(ofMoments[1]));
  std::vector<std::string> doubts;
  communicator.Collective([&] {
    doubts = Write(this, std::move(light), this->Ignored, vtkImageData::GetData(inputs[MEDIUM]), outputs, &pieces);
  });
  this->WarnOnce(doubts);
  this->Solved->Keep(
    this->Superclass::GetMTime(), tyndall::OwnAxesOf(this), inputs, this->GetNumberOfInputPorts(), outputs);
  this->SolvedInPieces = true;
}

void vtkScatteringSolver::WriteSolved(
  tyndall::LightField&& light, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->TellOfPieces(light, false);
  this->Note(light);
  vtkImageData* const medium = vtkImageData::GetData(inputs[MEDIUM]);
  this->WarnOnce(Write(this, std::move(light), this->Ignored, medium, outputs, nullptr));
  this->Solved->Keep(outputs);
  this->CropToRequest(inputs, outputs);
}

/// Warns on the first rank alone: the light is that of all.
void vtkScatteringSolver::WarnOnce(const std::vector<std::string>& doubts)
{
  for (const std::string& doubt : this->IsFirstRank ? doubts : std::vector<std::string>())
  {
    vtkWarningMacro(<< doubt);
  }
}

tyndall::ToneMapping vtkScatteringSolver::Tones() const
{
  tyndall::ToneMapping tones;
  tones.exposure = this->Exposure;
  tones.curve = static_cast<tyndall::ToneCurve>(this->ToneCurve);
  return tones;
}

/// What is made of the light of this rank's piece. All ranks call it.
void vtkScatteringSolver::ColorPiece(tyndall::Communicator& communicator, const tyndall::PieceBlocks& pieces,
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::RequireSame(communicator, "LitColor, Exposure or ToneCurve", true,
    { this->LitColor ? 1.0 : 0.0, this->Exposure, 1.0 * this->ToneCurve });
  if (!this->LitColor)
  {
    return;
  }
  vtkImageData* const output = vtkImageData::GetData(outputs, 0);
  const tyndall::PieceOfMedium piece(communicator, pieces, this, vtkImageData::GetData(inputs[MEDIUM]));
  vtkSmartPointer<vtkImageData> own; // whose array the fluence may be
  tyndall::FloatField fluence;
  communicator.Collective([&] {
    if (pieces.HasOwn())
    {
      own = pieces.OwnImage(output);
      fluence = tyndall::ReadCells(own, "fluence", tyndall::Need::Required);
    }
  });
  tyndall::LitColor lit =
    tyndall::ColorLitMediumInBlocks(communicator, pieces.Partition(), piece.medium, fluence, this->Tones());
  std::vector<float> rgba(lit.rgba.begin(), lit.rgba.end());
  pieces.SpreadToHeld(communicator, rgba, 4);
  lit.rgba.assign(rgba.begin(), rgba.end());
  if (pieces.Held().VoxelCount() > 0)
  {
    tyndall::WriteLitColor(std::move(lit), output);
  }
}

/// What is made of the light of the whole image, and the piece that was asked for.
void vtkScatteringSolver::CropToRequest(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkImageData* const output = vtkImageData::GetData(outputs, 0);
  if (this->LitColor)
  {
    const tyndall::MediumInput input = tyndall::ReadMedium(this, vtkImageData::GetData(inputs[MEDIUM]));
    const tyndall::FloatField fluence = tyndall::ReadCells(output, "fluence", tyndall::Need::Required);
    tyndall::WriteLitColor(tyndall::ColorLitMedium(input.medium, fluence, this->Tones()), output);
  }
  tyndall::KeepWhatIsAskedFor(outputs->GetInformationObject(0), output);
}

void vtkScatteringSolver::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Decomposition: " << this->Decomposition << "\n";
  os << indent << "Quality: " << this->Quality << "\n";
  os << indent << "Preview: " << this->Preview << "\n";
  os << indent << "MemoryBudget: " << this->MemoryBudget << "\n";
  os << indent << "SettingsUsed: " << this->SettingsUsed << "\n";
  os << indent << "LitColor: " << this->LitColor << "\n";
  os << indent << "Exposure: " << this->Exposure << "\n";
  os << indent << "ToneCurve: " << this->ToneCurve << "\n";
}
